// What every fuzz target asks of its reader: that it accepts its input or throws InputError with one line
// that names the file, within a time that grows no faster than the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/frames.h"

/// A target: reads `size` bytes as its reader's file. Throws whatever is wrong with the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace understudy::fuzz {

/// What a reader has done wrong. Nothing that a target calls throws it, so it ends a fuzzer and fails a test.
struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};

/// Throws Finding with `what` unless it `holds`.
void require(bool holds, const std::string& what);
void require_finite(double value, const std::string& what);
void require_finite(std::span<const double> values, const std::string& what);
void require_finite(const Vec3& value, const std::string& what);
void require_finite(const Pose& X, const std::string& what);
/// |a - b| <= absolute + relative |b|
void require_near(double a, double b, double absolute, double relative, const std::string& what);

std::string_view text_of(const std::uint8_t* data, std::size_t size);

/// A file that each input fills anew, in a folder of this process that is removed at its end.
class InputFile {
 public:
  explicit InputFile(const std::string& name);
  const std::filesystem::path& fill(std::string_view content) const;
  const std::filesystem::path& path() const { return path_; }
  static const std::filesystem::path& folder();

 private:
  std::filesystem::path path_;
};

/// Processor time that reading may take: [s] of the calling thread. `made`: steps that the input asks for,
/// such as the chords of an arc.
double time_limit(std::size_t bytes, std::size_t made = 0);
/// [s], of the calling thread.
double processor_time();

/// Throws Finding where a refusal does not name `file`, or names it with an empty reason.
void check_refusal(const InputError& error, const std::string& file);
/// Throws Finding where `seconds` is more than time_limit().
void check_time(double seconds, std::size_t bytes, std::size_t made = 0);

/// Calls `read` for an input of `bytes`, called `file`; false: it was refused. What else `read` throws goes
/// on. `made` is asked afterwards, see time_limit().
template <typename Read, typename Made>
bool accepts(std::size_t bytes, const std::string& file, const Read& read, const Made& made) {
  const double begin = processor_time();
  bool accepted = true;
  try {
    read();
  } catch (const InputError& error) {
    accepted = false;
    check_refusal(error, file);
  }
  check_time(processor_time() - begin, bytes, made());
  return accepted;
}

template <typename Read>
bool accepts(std::size_t bytes, const std::string& file, const Read& read) {
  return accepts(bytes, file, read, [] { return std::size_t{0}; });
}

}  // namespace understudy::fuzz
