#include "report/video/mp4_writer.h"

#include <cstdlib>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"

namespace understudy::report {
namespace {

/// FFmpeg writes its own remarks to standard error.
void silence_codecs() {
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  ::setenv("OPENCV_LOG_LEVEL", "SILENT", 0);
}

}  // namespace

Mp4Writer::Mp4Writer(double frames_per_second, cv::Size size)
    : folder_("video"), file_(folder_.path() / "frames.mp4") {
  silence_codecs();
  struct Choice {
    int tag;
    const char* name;
  };
  for (const Choice& each : {Choice{cv::VideoWriter::fourcc('a', 'v', 'c', '1'), "H.264"},
                             Choice{cv::VideoWriter::fourcc('m', 'p', '4', 'v'), "MPEG-4"}}) {
    codec_ = each.name;
    if (writer_.open(file_.string(), cv::CAP_FFMPEG, each.tag, frames_per_second, size, true)) return;
  }
  throw MachineError("no video can be encoded: OpenCV has no FFmpeg here (Debian: libopencv-videoio406)");
}

void Mp4Writer::add(const cv::Mat& frame) {
  writer_.write(frame);
  ++frames_;
}

std::string Mp4Writer::finish() {
  writer_.release();
  cv::VideoCapture written(file_.string(), cv::CAP_FFMPEG);
  int count = 0;
  while (written.isOpened() && written.grab()) ++count;
  if (count != frames_)
    throw MachineError(fmt::format("{} of {} frames of the video were written to {}: is the disk full?",
                                   count, frames_, folder_.path().string()));
  return read_file(file_.string());
}

}  // namespace understudy::report
