#include "core/file/staged_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy {
namespace fs = std::filesystem;
namespace {

constexpr int kLinks = 40;                // as the operating system follows
constexpr std::size_t kNameLength = 200;  // of 255 bytes: the rest tells which process writes

std::string message_of(const fs::path& path, int error) {
  return "cannot write " + path.string() + ": " + std::generic_category().message(error);
}

void write_as_it_is(const fs::path& path, const std::string& content) {
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0 || !write_all(file.get(), content)) failed_to_write(path, errno);
}

/// All files on their way to `target` begin so; the process and a count follow.
std::string prefix_of(const fs::path& target) {
  return fmt::format(".{}.part-", target.filename().string().substr(0, kNameLength));
}

bool all_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
}

/// Of a name as prefix_of() and create_beside() make it; 0: it is another.
pid_t writer_in(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return 0;
  const std::string_view rest = name.substr(prefix.size());
  const std::size_t dash = std::min(rest.find('-'), rest.size());
  if (!all_digits(rest.substr(0, dash)) || dash == rest.size() || !all_digits(rest.substr(dash + 1)))
    return 0;
  pid_t writer = 0;
  std::from_chars(rest.data(), rest.data() + dash, writer);
  return writer;
}

/// What processes left that no longer live: neither under that number here, nor elsewhere with their lock.
void remove_leftovers(const fs::path& target) {
  const std::string prefix = prefix_of(target);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const pid_t writer = writer_in(entry->path().filename().string(), prefix);
    if (writer <= 0 || ::kill(writer, 0) == 0 || errno != ESRCH) continue;
    const Descriptor left(::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (left.get() >= 0 && ::flock(left.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
  }
}

/// A new file beside `target`, and its name.
Descriptor create_beside(const fs::path& target, fs::path& part) {
  static std::atomic<int> count{0};
  int file = -1;
  do {
    part = target.parent_path() / fmt::format("{}{}-{}", prefix_of(target), ::getpid(), ++count);
    file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (file < 0 && errno == EEXIST);
  return Descriptor(file);
}

}  // namespace

bool write_all(int file, std::string_view content) {
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t n = ::write(file, content.data() + written, content.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    written += static_cast<std::size_t>(n);
  }
  return true;
}

void failed_to_write(const fs::path& path, int error) { throw MachineError(message_of(path, error)); }

void cannot_write(const fs::path& path, int error) {
  if (error == ENOSPC || error == EDQUOT || error == EIO || error == EFBIG) failed_to_write(path, error);
  throw InputError(message_of(path, error));
}

fs::path behind_links(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status is = fs::status(path, ignored);
  if (fs::exists(is) && !fs::is_regular_file(is)) return path;  // /dev/stdout leads to what has no name
  fs::path file = path;
  for (int links = 0; links < kLinks && fs::is_symlink(file, ignored); ++links)
    file = file.parent_path() / fs::read_symlink(file, ignored);  // an absolute one stands alone
  return file;
}

StagedFile::StagedFile(const fs::path& path, const std::string& content)
    : StagedFile(path, [&](const AppendPiece& append) { append(content); }) {}

StagedFile::StagedFile(const fs::path& path, const MadeContent& make)
    : path_(path), target_(behind_links(path)) {
  std::error_code ignored;
  const fs::file_status is = fs::status(target_, ignored);
  if (fs::is_directory(is)) failed_to_write(path_, EISDIR);
  if (fs::exists(is) && !fs::is_regular_file(is)) {
    make([&](std::string_view piece) { as_it_is_ += piece; });
    return;
  }
  remove_leftovers(target_);
  file_ = create_beside(target_, part_);
  if (file_.get() < 0) failed_to_write(path_, errno);
  partial_.emplace(part_);
  (void)::flock(file_.get(), LOCK_EX | LOCK_NB);  // where the file system has locks
  make([&](std::string_view piece) {
    if (!write_all(file_.get(), piece)) failed_to_write(path_, errno);
  });
  // Closing a copy tells of errors that a file system keeps back until then, and leaves the lock.
  const int copy = ::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0);
  if (copy >= 0 && ::close(copy) != 0) failed_to_write(path_, errno);
}

void StagedFile::commit() {
  if (!partial_) return write_as_it_is(target_, as_it_is_);
  if (std::rename(part_.c_str(), target_.c_str()) != 0) failed_to_write(path_, errno);
  partial_->keep();
}

}  // namespace understudy
