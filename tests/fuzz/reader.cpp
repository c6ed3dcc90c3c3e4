#include "tests/fuzz/reader.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace understudy::fuzz {
namespace {

namespace fs = std::filesystem;

// A thousand times what readers take, even under sanitizers: only what grows faster than the file meets it.
constexpr double kSecondsAlways = 1;
constexpr double kSecondsPerByte = 100e-6;
constexpr double kSecondsPerStep = 1e-3;

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / fmt::format("understudy-fuzz-{}", ::getpid())) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void require(bool holds, const std::string& what) {
  if (!holds) throw Finding(what);
}

void require_finite(double value, const std::string& what) {
  require(std::isfinite(value), fmt::format("{} is {}", what, value));
}

void require_finite(std::span<const double> values, const std::string& what) {
  for (const double value : values) require_finite(value, what);
}

void require_finite(const Vec3& value, const std::string& what) {
  require(value.allFinite(), fmt::format("{} is ({}, {}, {})", what, value.x(), value.y(), value.z()));
}

void require_finite(const Pose& X, const std::string& what) {
  require(X.matrix().allFinite(), what + " holds a number that is not finite");
}

void require_near(double a, double b, double absolute, double relative, const std::string& what) {
  require(std::abs(a - b) <= absolute + relative * std::abs(b),
          fmt::format("{}: {} came back as {}", what, b, a));
}

std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

const fs::path& InputFile::folder() {
  static const Folder folder;
  return folder.path();
}

InputFile::InputFile(const std::string& name) : path_(folder() / name) {}

const fs::path& InputFile::fill(std::string_view content) const {
  std::ofstream file(path_, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path_.string());
  return path_;
}

double time_limit(std::size_t bytes, std::size_t made) {
  return kSecondsAlways + kSecondsPerByte * static_cast<double>(bytes) +
         kSecondsPerStep * static_cast<double>(made);
}

double processor_time() {
  std::timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void check_refusal(const InputError& error, const std::string& file) {
  const std::string what = error.what();
  // A file that the input names is in its own words: "cannot read arm.urdf: No such file or directory".
  require(what.find(file) != std::string::npos || what.starts_with("cannot read "),
          "the refusal does not name the file: " + what);
  require(what.size() > file.size() + 2, "the refusal has no reason: " + what);
}

void check_time(double seconds, std::size_t bytes, std::size_t made) {
  require(seconds <= time_limit(bytes, made), fmt::format("{} bytes took {:.2f} s to read", bytes, seconds));
}

}  // namespace understudy::fuzz
