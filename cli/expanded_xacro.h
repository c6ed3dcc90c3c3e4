// The URDF that the program `xacro` makes of a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/file/scratch_folder.h"

namespace understudy::cli {

/// Runs xacro in the box of plug-ins (calibration/plugin/box.h), for a file can make it evaluate Python.
/// Throws InputError, one line, where it is not installed, fails, or takes longer than 60 s.
class ExpandedXacro {
 public:
  ExpandedXacro(const std::filesystem::path& file, const std::vector<std::string>& arguments);

  /// Gone with the object.
  const std::filesystem::path& path() const { return path_; }

 private:
  ScratchFolder folder_{"xacro"};
  std::filesystem::path path_;
};

}  // namespace understudy::cli
