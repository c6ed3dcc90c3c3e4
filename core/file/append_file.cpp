#include "core/file/append_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>

#include "core/error.h"
#include "core/file/staged_file.h"

namespace understudy {
namespace {

constexpr std::chrono::seconds kToDisk{1};

}  // namespace

AppendFile::AppendFile(std::filesystem::path path, Begin begin) : path_(std::move(path)) {
  std::error_code ignored;
  const bool plain =
      !std::filesystem::exists(path_, ignored) || std::filesystem::is_regular_file(path_, ignored);
  const int how = begin == Begin::anew && plain ? O_CREAT | O_EXCL : 0;
  file_ = Descriptor(::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | how, 0644));
  if (!file_.is_open() && errno == EEXIST)
    throw InputError({path_.string()},
                     "it is there already, and nothing is written over it: name another file");
  if (!file_.is_open()) cannot_write(path_, errno);
  to_disk_ = std::jthread([this](const std::stop_token& stop) { keep_on_disk(stop); });
}

AppendFile::~AppendFile() = default;

void AppendFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file_.get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) failed_to_write(path_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void AppendFile::keep_on_disk(const std::stop_token& stop) const {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    wake.wait_for(lock, stop, kToDisk, [] { return false; });
    ::fdatasync(file_.get());
  }
}

}  // namespace understudy
