// Private to this folder: frames as the bytes of an .mp4.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "core/file/scratch_folder.h"
#include "vision/formats/formats.h"

namespace understudy::report {

/// H.264, which browsers play; MPEG-4 part 2 where there is no encoder of it.
class Mp4Writer {
 public:
  /// Throws MachineError where OpenCV has neither, and where there is no room for temporary files.
  Mp4Writer(double frames_per_second, cv::Size size);
  void add(const cv::Mat& frame);
  /// Reads what was written; throws MachineError where frames are missing, as on a full disk.
  std::string finish();
  const std::string& codec() const { return codec_; }

 private:
  ScratchFolder folder_;
  std::filesystem::path file_;
  std::unique_ptr<vision::VideoWriter> writer_;
  std::string codec_;
  int frames_ = 0;
};

}  // namespace understudy::report
