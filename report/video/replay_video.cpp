#include "report/video/replay_video.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "report/picture/picture_text.h"
#include "report/video/captions.h"
#include "report/video/mp4_writer.h"
#include "report/video/replay_scene.h"

namespace understudy::report {
namespace {

constexpr double kView = 30;         // [deg], vertical
constexpr double kCaptionTime = 3;   // [s of the film] that a finding is shown for
constexpr double kPixelOfText = 22;  // [px], height of a line at scale 1
const cv::Scalar kErrorInk(40, 40, 190), kWarningInk(20, 110, 180), kBar(190, 120, 40);  // blue, green, red

void check(const VideoSettings& s) {
  const auto within = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw InputError(fmt::format("video: {} is {:g}, must be in {:g}..{:g}", name, value, low, high));
  };
  within("its length in s", s.duration, 0.2, 600);
  within("frames per second", s.frames_per_second, 1, 60);
  within("its width in pixels", s.width, 320, 4096);
  within("its height in pixels", s.height, 240, 4096);
  if (s.width % 4 != 0 || s.height % 2 != 0)
    throw InputError(fmt::format("video: {} x {} pixels: a width by fours and an even height are needed",
                                 s.width, s.height));
}

/// Where the eye stands, the same for all frames.
struct Camera {
  Vec3 target{0, 0, 0}, from{0, -1, 0};  ///< [m]; `from` is the way to the eye
};

/// As far as a ball of that radius fills the narrower side of the panel.
Camera look_at(const Vec3& centre, double radius, const Vec3& direction, cv::Size panel) {
  const double narrow = std::min(1., static_cast<double>(panel.width) / panel.height);
  return {centre, direction.normalized() * radius / (std::tan(from_deg(kView) / 2) * narrow)};
}

class Film {
 public:
  Film(const RecordedReplay& replay, const RecordedRehearsal& recorded, const VideoSettings& settings)
      : replay_(replay),
        recorded_(recorded),
        settings_(settings),
        text_size_(std::max(0.4, settings.height / 1200.)),
        line_height_(static_cast<int>(std::lround(2 * kPixelOfText * text_size_))),
        panel_(settings.width / 2, settings.height - 3 * line_height_) {
    const double first = replay.path.front().time, last = replay.path.back().time;
    place_cameras({first, 0.5 * (first + last), last});
    caption_time_ = kCaptionTime * (last - first) / settings.duration;
  }

  cv::Mat frame(double time) const {
    cv::Mat canvas(settings_.height, settings_.width, CV_8UC3, kPaper);
    draw_panel(time, machine_, canvas(cv::Rect({0, 0}, panel_)));
    draw_panel(time, print_, canvas(cv::Rect({panel_.width, 0}, panel_)));
    cv::line(canvas, {panel_.width, 0}, {panel_.width, panel_.height}, kPaper, 3);
    write_below(time, canvas);
    return canvas;
  }

 private:
  void place_cameras(const std::vector<double>& times) {
    Eigen::AlignedBox3d machine(Vec3(-0.08, -0.08, 0), Vec3(0.08, 0.08, 0)), print;
    for (const double time : times)
      for (const auto& shape : replay_scene(replay_, time, 1e-3).shapes)
        machine.extend(Vec3(shape.shape.X_FS.translation()));
    print = box_of_beads(replay_.beads);
    if (print.isEmpty())
      for (const double time : times) print.extend(Vec3(tool_at(replay_, time).translation()));
    machine_ = look_at(machine.center(), 0.5 * machine.diagonal().norm() + 0.03, {0.62, -0.74, 0.24}, panel_);
    const double radius = std::max(6e-3, 0.65 * print.diagonal().norm());
    print_ = look_at(print.center(), radius, {0.5, -0.75, 0.42}, panel_);
  }

  void draw_panel(double time, const Camera& camera, cv::Mat panel) const {
    const bool close = &camera == &print_;
    const double pixel = 2 * std::tan(from_deg(kView) / 2) * camera.from.norm() / panel.rows;
    renderer::PictureScene scene =
        replay_scene(replay_, time, pixel, close ? ShownBodies::tip : ShownBodies::machine);
    // The print is carried by its table; the machine stands.
    scene.target_W = close ? Vec3(drawn_from_W(replay_, time) * camera.target) : camera.target;
    scene.eye_W = scene.target_W + camera.from;
    scene.field_of_view = from_deg(kView);
    scene.width = panel.cols;
    scene.height = panel.rows;
    renderer::Picture picture = renderer::render_picture(std::move(scene));
    const cv::Mat rgb(picture.height, picture.width, CV_8UC3, picture.rgb.data());
    cv::cvtColor(rgb, panel, cv::COLOR_RGB2BGR);
  }

  /// Of the last point of the trace by then; 0 without a trace.
  int line_at(double time) const {
    const auto& trace = recorded_.trace;
    const auto next =
        std::ranges::upper_bound(trace, time, {}, [](const rehearsal::TracePoint& p) { return p.time; });
    return next == trace.begin() ? 0 : (next - 1)->line;
  }

  void write_below(double time, cv::Mat& canvas) const {
    const double first = replay_.path.front().time, last = replay_.path.back().time;
    const int bar = std::max(2, line_height_ / 10);
    const double share = last > first ? (time - first) / (last - first) : 1;
    cv::rectangle(canvas, {0, panel_.height},
                  {static_cast<int>(share * settings_.width), panel_.height + bar}, kBar, cv::FILLED);
    const int margin = line_height_ / 2;
    int y = panel_.height + line_height_ - bar;
    const int line = line_at(time);
    write(canvas, in_ascii(replay_.title), {margin, y}, text_size_);
    write(canvas,
          fmt::format("{}{:.1f} s of {:.1f} s", line > 0 ? fmt::format("line {}, ", line) : "", time, last),
          {settings_.width - margin, y}, text_size_, kFaint, Align::right);
    for (const Caption& caption : captions_at(recorded_.findings, time, caption_time_)) {
      y += static_cast<int>(0.85 * line_height_);
      write(canvas, fitted(caption.text, settings_.width - 2 * margin), {margin, y}, text_size_,
            caption.error ? kErrorInk : kWarningInk);
    }
  }

  /// What has no room is cut off.
  std::string fitted(std::string text, int width) const {
    const auto wide = [&](const std::string& words) {
      int base = 0;
      return cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, text_size_, 1, &base).width > width;
    };
    if (!wide(text)) return text;
    while (!text.empty() && wide(text + " ...")) text.pop_back();
    return text + " ...";
  }

  const RecordedReplay& replay_;
  const RecordedRehearsal& recorded_;
  const VideoSettings& settings_;
  double text_size_;
  int line_height_;
  cv::Size panel_;
  Camera machine_, print_;
  double caption_time_ = 0;  // [s]
};

}  // namespace

std::vector<double> frame_times(const RecordedReplay& replay, const VideoSettings& settings) {
  const double first = replay.path.front().time, last = replay.path.back().time;
  const int frames =
      std::max(2, static_cast<int>(std::lround(settings.duration * settings.frames_per_second)));
  std::vector<double> times;
  for (int i = 0; i < frames; ++i) times.push_back(first + (last - first) * i / (frames - 1));
  return times;
}

Video replay_video(const RecordedReplay& replay, const RecordedRehearsal& recorded,
                   const VideoSettings& settings, const Progress& progress) {
  check(settings);
  const Film film(replay, recorded, settings);
  const std::vector<double> times = frame_times(replay, settings);
  Mp4Writer writer(settings.frames_per_second, {settings.width, settings.height});
  Video video;
  for (const double time : times) {
    stop_if_interrupted();
    writer.add(film.frame(time));
    ++video.frames;
    if (progress)
      progress(static_cast<double>(video.frames) / static_cast<double>(times.size()),
               fmt::format("frame {} of {}", video.frames, times.size()));
  }
  video.bytes = writer.finish();
  video.codec = writer.codec();
  return video;
}

}  // namespace understudy::report
