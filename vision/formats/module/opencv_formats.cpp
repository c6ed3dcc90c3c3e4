#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "core/version.h"
#include "vision/formats/formats.h"

namespace understudy::vision {
namespace {

class OpencvReader : public VideoReader {
 public:
  bool read(cv::Mat& frame) override { return video_.read(frame) && !frame.empty(); }
  bool skip() override { return video_.grab(); }
  double position() const override { return 1e-3 * video_.get(cv::CAP_PROP_POS_MSEC); }

  cv::VideoCapture& video() { return video_; }

 private:
  cv::VideoCapture video_;
};

class OpencvWriter : public VideoWriter {
 public:
  void write(const cv::Mat& frame) override { video_.write(frame); }
  cv::VideoWriter& video() { return video_; }

 private:
  cv::VideoWriter video_;
};

/// FFmpeg and OpenCV write their own remarks to standard error; what went wrong is said once, by the caller.
void silence() {
  static_cast<void>(::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0));
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

/// imdecode() tells std::cerr what it made of a picture that is cut short.
class QuietStream {
 public:
  QuietStream() : told_(std::cerr.rdbuf(nullptr)) {}
  ~QuietStream() { std::cerr.rdbuf(told_); }
  QuietStream(const QuietStream&) = delete;
  QuietStream& operator=(const QuietStream&) = delete;

 private:
  std::streambuf* told_;
};

int milliseconds(double seconds) { return static_cast<int>(1e3 * seconds); }

class OpencvFormats : public Formats {
 public:
  cv::Mat decode_grey(const std::string& bytes) const override {
    if (bytes.empty()) return {};
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    const QuietStream quiet;
    try {
      return cv::imdecode(raw, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
      return {};
    }
  }
  std::unique_ptr<VideoReader> open_file(const std::string& file) const override {
    auto reader = std::make_unique<OpencvReader>();
    if (!reader->video().open(file, cv::CAP_FFMPEG)) return nullptr;
    return reader;
  }
  std::unique_ptr<VideoReader> open_device(const std::string& device) const override {
    auto reader = std::make_unique<OpencvReader>();
    if (!reader->video().open(device, cv::CAP_V4L2)) return nullptr;
    reader->video().set(cv::CAP_PROP_BUFFERSIZE, 1);
    return reader;
  }
  std::unique_ptr<VideoReader> open_network(const std::string& address,
                                            const NetworkLimits& limits) const override {
    auto reader = std::make_unique<OpencvReader>();
    const std::vector<int> within{cv::CAP_PROP_OPEN_TIMEOUT_MSEC, milliseconds(limits.open),
                                  cv::CAP_PROP_READ_TIMEOUT_MSEC, milliseconds(limits.read)};
    if (!reader->video().open(address, cv::CAP_FFMPEG, within)) return nullptr;
    return reader;
  }
  std::unique_ptr<VideoWriter> open_film(const std::string& file, const std::string& code,
                                         double frames_per_second, cv::Size size) const override {
    auto writer = std::make_unique<OpencvWriter>();
    const int tag = cv::VideoWriter::fourcc(code.at(0), code.at(1), code.at(2), code.at(3));
    if (!writer->video().open(file, cv::CAP_FFMPEG, tag, frames_per_second, size, true)) return nullptr;
    return writer;
  }
};

}  // namespace
}  // namespace understudy::vision

/// What formats() of vision/formats/formats.cpp looks for; null where that is of another version.
extern "C" __attribute__((visibility("default"))) const understudy::vision::Formats* understudy_formats(
    const char* version) {
  if (std::string(version) != understudy::kVersion) return nullptr;
  understudy::vision::silence();
  static const understudy::vision::OpencvFormats formats;
  return &formats;
}
