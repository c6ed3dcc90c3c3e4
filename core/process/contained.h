// Work on a stranger's bytes in a process of its own, which may crash, hang or grow without harm to this one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace understudy {

struct ContainedLimits {
  double seconds = 10;                   ///< [s], of processor time
  std::uint64_t memory = 8'000'000'000;  ///< [bytes], beyond what this process has mapped
  std::size_t result = 1'000'000'000;    ///< [bytes]
};

/// What `work` returns. It runs in a copy of this process that opens no file and starts no program, and whose
/// standard error goes nowhere. Throws InputError without a place: what `work` throws, or, beginning with
/// `what` ("reading it"), that it crashed or went beyond a limit; Interrupted; MachineError where no process
/// can be started. Under a sanitizer neither memory nor open files are limited.
std::string run_contained(const std::string& what, const std::function<std::string()>& work,
                          const ContainedLimits& limits);

}  // namespace understudy
