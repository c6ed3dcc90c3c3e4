#include "core/file/output_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace understudy {
namespace fs = std::filesystem;

void check_writable(const fs::path& path) {
  std::error_code ignored;
  const fs::path target = behind_links(path);
  struct stat is {};
  const bool exists = ::stat(target.c_str(), &is) == 0;
  if (!exists && errno != ENOENT) cannot_write(path, errno);
  if (!target.has_filename() || (exists && S_ISDIR(is.st_mode))) cannot_write(path, EISDIR);
  const bool special = exists && !S_ISREG(is.st_mode);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (::access(special ? target.c_str() : folder.c_str(), W_OK) != 0) cannot_write(path, errno);
}

void write_file(const fs::path& path, const std::string& content) { StagedFile(path, content).commit(); }

void write_file(const fs::path& path, const MadeContent& make) { StagedFile(path, make).commit(); }

}  // namespace understudy
