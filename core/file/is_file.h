// What stands at a place. A place that cannot be looked at (a name that is too long, links in a ring, a
// folder that is closed to the user) is no file and no folder; to read from it tells why.
#pragma once

#include <filesystem>
#include <system_error>

namespace understudy {

inline bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

inline bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

/// Anything: a device as well.
inline bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

}  // namespace understudy
