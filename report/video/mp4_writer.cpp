#include "report/video/mp4_writer.h"

#include <cstdlib>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"

namespace understudy::report {
namespace {

/// FFmpeg writes its own remarks to standard error.
void silence_codecs() {
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  ::setenv("OPENCV_LOG_LEVEL", "SILENT", 0);
}

// [bytes] of a film of a few frames: a disk that has no more is told before they are drawn. FFmpeg does not
// say why it cannot write.
constexpr std::size_t kLeastRoom = 65'536;

void require_room(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "room";
  write_file(file, std::string(kLeastRoom, '\0'));
  std::filesystem::remove(file);
}

}  // namespace

Mp4Writer::Mp4Writer(double frames_per_second, cv::Size size)
    : folder_("video"), file_(folder_.path() / "frames.mp4") {
  require_room(folder_.path());
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
    throw MachineError(
        fmt::format("cannot write {}: {} of {} frames of the film are there; is the disk full?",
                    file_.string(), count, frames_));
  return read_file(file_.string());
}

}  // namespace understudy::report
