#include "core/file/files_named.h"

#include <glob.h>

#include <string_view>

namespace understudy {
namespace fs = std::filesystem;

std::vector<fs::path> files_named(const fs::path& folder, const std::string& name) {
  std::string pattern;
  for (const char c : (folder / "").string()) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  glob_t found{};
  std::vector<fs::path> files;
  if (::glob((pattern + name).c_str(), 0, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  return files;
}

}  // namespace understudy
