#include "report/video/mp4_writer.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"

namespace understudy::report {
namespace {

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
  struct Choice {
    const char* code;
    const char* name;
  };
  for (const Choice& each : {Choice{"avc1", "H.264"}, Choice{"mp4v", "MPEG-4"}}) {
    codec_ = each.name;
    writer_ = vision::formats().open_film(file_.string(), each.code, frames_per_second, size);
    if (writer_) return;
  }
  throw MachineError("no video can be encoded: OpenCV has no FFmpeg here (Debian: libopencv-videoio406)");
}

void Mp4Writer::add(const cv::Mat& frame) {
  writer_->write(frame);
  ++frames_;
}

std::string Mp4Writer::finish() {
  writer_.reset();
  const std::unique_ptr<vision::VideoReader> written = vision::formats().open_file(file_.string());
  int count = 0;
  while (written && written->skip()) ++count;
  if (count != frames_)
    throw MachineError(
        fmt::format("cannot write {}: {} of {} frames of the film are there; is the disk full?",
                    file_.string(), count, frames_));
  return read_file(file_.string());
}

}  // namespace understudy::report
