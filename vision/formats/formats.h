// Formats of pictures and videos besides PNG. OpenCV's libraries of formats load 240 others, for 0.2 s at
// each start of a program that links them, so they are linked by a module that is loaded when one of its
// functions is first asked for.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

namespace understudy::vision {

class VideoReader {
 public:
  virtual ~VideoReader() = default;
  /// The next frame, 8-bit, grey or blue first; false at the end.
  virtual bool read(cv::Mat& frame) = 0;
  /// Passes over a frame without decoding it; false at the end.
  virtual bool skip() = 0;
  /// [s] when the last frame was exposed, as the driver says; of V4L2 by the clock that never jumps.
  virtual double position() const = 0;
};

class VideoWriter {
 public:
  virtual ~VideoWriter() = default;
  virtual void write(const cv::Mat& frame) = 0;  // blue first
};

/// Of an address: [s] after which no answer is a failure.
struct NetworkLimits {
  double open, read;
};

/// Each function returns nothing (an empty picture, a null pointer) where OpenCV cannot do it.
class Formats {
 public:
  virtual ~Formats() = default;
  /// 8-bit grey of the whole bytes of a file, not turned by what its metadata say.
  virtual cv::Mat decode_grey(const std::string& bytes) const = 0;
  virtual std::unique_ptr<VideoReader> open_file(const std::string& file) const = 0;
  /// By V4L2, with one frame in its queue, so that a frame is never older than one period.
  virtual std::unique_ptr<VideoReader> open_device(const std::string& device) const = 0;
  virtual std::unique_ptr<VideoReader> open_network(const std::string& address,
                                                    const NetworkLimits& limits) const = 0;
  /// An .mp4; `code`: four letters of the codec, as FFmpeg has it ("avc1": H.264, "mp4v": MPEG-4 part 2).
  virtual std::unique_ptr<VideoWriter> open_film(const std::string& file, const std::string& code,
                                                 double frames_per_second, cv::Size size) const = 0;
};

/// The module. Throws MachineError where it lies neither beside the program nor where it was built or
/// installed.
std::filesystem::path formats_file();

/// Loads the module. Throws MachineError where it is missing or of another version.
const Formats& formats();

}  // namespace understudy::vision
