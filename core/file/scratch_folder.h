// A folder for files that nobody shall see.
#pragma once

#include <filesystem>
#include <string>

#include "core/partial_results.h"

namespace understudy {

/// In the system's folder of temporary files; goes with the object, or when an interrupt ends the process.
/// Throws MachineError where it cannot be made.
class ScratchFolder {
 public:
  /// `purpose`: in its name, for who finds it.
  explicit ScratchFolder(const std::string& purpose);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  PartialResult goes_;
};

}  // namespace understudy
