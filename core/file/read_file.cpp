#include "core/file/read_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/descriptor.h"
#include "core/interrupt.h"

namespace understudy {
namespace {

constexpr int kTick = 100;  // [ms] between looks at what the user wants, while a pipe has nothing
constexpr std::size_t kChunk = 1 << 16;

[[noreturn]] void cannot_read(const std::filesystem::path& path, const std::string& why) {
  throw InputError("cannot read " + path.string() + ": " + why);
}

[[noreturn]] void cannot_read(const std::filesystem::path& path) {
  cannot_read(path, std::generic_category().message(errno));
}

/// Without blocking: a pipe that nobody writes to would wait here for good.
Descriptor open_to_read(const std::filesystem::path& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0) cannot_read(path);
  return file;
}

void wait_for(const Descriptor& file) {
  pollfd watched{file.get(), POLLIN, 0};
  do stop_if_interrupted();
  while (::poll(&watched, 1, kTick) <= 0);
}

/// What the file is; neither a folder nor a device.
struct stat checked(const Descriptor& file, const std::filesystem::path& path) {
  struct stat is {};
  if (::fstat(file.get(), &is) != 0) cannot_read(path);
  if (S_ISDIR(is.st_mode)) cannot_read(path, "it is a folder");
  if (!S_ISREG(is.st_mode) && !S_ISFIFO(is.st_mode) && !S_ISSOCK(is.st_mode))
    cannot_read(path, "it is a device, not a file");
  return is;
}

/// Appends up to `most` bytes; false at the end.
bool append_next(const Descriptor& file, const std::filesystem::path& path, std::size_t most,
                 std::string& content) {
  std::array<char, kChunk> buffer;
  while (true) {
    wait_for(file);
    const ssize_t n = ::read(file.get(), buffer.data(), std::min(most, buffer.size()));
    if (n == 0) return false;
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (n < 0) cannot_read(path);
    content.append(buffer.data(), static_cast<std::size_t>(n));
    return true;
  }
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
  const Descriptor file = open_to_read(path);
  const struct stat is = checked(file, path);
  const auto too_large = [&] {
    cannot_read(path, fmt::format("it is larger than {} MB (docs/limits.md)", limit / 1'000'000));
  };
  if (S_ISREG(is.st_mode) && static_cast<std::size_t>(is.st_size) > limit) too_large();
  std::string content;
  if (S_ISREG(is.st_mode)) content.reserve(static_cast<std::size_t>(is.st_size));
  while (append_next(file, path, kChunk, content))
    if (content.size() > limit) too_large();
  return content;
}

FileBeginning read_beginning(const std::filesystem::path& path, std::size_t most) {
  const Descriptor file = open_to_read(path);
  const struct stat is = checked(file, path);
  const std::size_t size = S_ISREG(is.st_mode) ? static_cast<std::size_t>(is.st_size) : 0;
  FileBeginning beginning;
  beginning.content.reserve(std::min(size, most));
  while (beginning.content.size() < most &&
         append_next(file, path, most - beginning.content.size(), beginning.content)) {
  }
  beginning.left_out = size - std::min(size, beginning.content.size());
  return beginning;
}

}  // namespace understudy
