#include "core/file/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/partial_results.h"

namespace understudy {
namespace fs = std::filesystem;
namespace {

std::string text_of(int error) { return std::generic_category().message(error); }

/// Of the user's doing, or of the disk's.
[[noreturn]] void cannot_write(const fs::path& path, int error) {
  const std::string message = "cannot write " + path.string() + ": " + text_of(error);
  if (error == ENOSPC || error == EDQUOT || error == EIO || error == EFBIG) throw MachineError(message);
  throw InputError(message);
}

bool write_all(int file, const std::string& content) {
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t n = ::write(file, content.data() + written, content.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    written += static_cast<std::size_t>(n);
  }
  return true;
}

void write_as_it_is(const fs::path& path, const std::string& content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) cannot_write(path, errno);
  const bool whole = write_all(file, content);
  const int error = errno;
  ::close(file);
  if (!whole) cannot_write(path, error);
}

/// A new file beside `target`, and its name.
int create_beside(const fs::path& target, fs::path& part) {
  static std::atomic<int> count{0};
  int file = -1;
  do {
    part =
        target.parent_path() / fmt::format(".{}.part-{}-{}", target.filename().string(), ::getpid(), ++count);
    file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (file < 0 && errno == EEXIST);
  return file;
}

}  // namespace

void check_writable(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) cannot_write(path, EISDIR);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const bool special = fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
  if (::access(special ? path.c_str() : folder.c_str(), W_OK) != 0) cannot_write(path, errno);
}

void write_file(const fs::path& path, const std::string& content) {
  std::error_code ignored;
  const fs::path target = fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
  const fs::file_status is = fs::status(target, ignored);
  if (fs::is_directory(is)) cannot_write(path, EISDIR);
  if (fs::exists(is) && !fs::is_regular_file(is)) return write_as_it_is(target, content);
  fs::path part;
  const int file = create_beside(target, part);
  if (file < 0) cannot_write(path, errno);
  const PartialResult partial(part);
  bool whole = write_all(file, content);
  int error = errno;
  if (::close(file) != 0 && whole) whole = false, error = errno;
  if (whole && std::rename(part.c_str(), target.c_str()) != 0) whole = false, error = errno;
  if (!whole) cannot_write(path, error);
}

}  // namespace understudy
