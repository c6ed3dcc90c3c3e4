// The fuzz targets by the names of their readers; CMake lists them out of the folder's sources.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace understudy::fuzz {

struct Target {
  const char* reader;
  int (*one_input)(const std::uint8_t* data, std::size_t size);
};

std::span<const Target> targets();
/// As LLVMFuzzerTestOneInput() of that reader's target. Throws std::out_of_range for a name that is none.
void run(const std::string& reader, const std::string& input);

}  // namespace understudy::fuzz
