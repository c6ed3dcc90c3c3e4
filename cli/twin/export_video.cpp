#include "cli/twin/export_video.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/export_video_command.h"
#include "cli/options/output_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "report/page/recorded_replay.h"
#include "report/recorded/recorded_rehearsal.h"

namespace understudy::cli {
namespace {

struct VideoCall {
  std::string folder, output, size;
  report::VideoSettings settings;
  OutputOptions told;
};

void read_size(VideoCall& call) {
  if (call.size.empty()) return;
  int end = -1;
  if (std::sscanf(call.size.c_str(), "%5dx%5d%n", &call.settings.width, &call.settings.height, &end) != 2 ||
      end != static_cast<int>(call.size.size()))
    throw InputError(fmt::format("--size '{}' does not read like 1280x720", call.size));
}

int export_video(VideoCall call) {
  check_video(call.output);
  read_size(call);
  const report::Video video = video_of(call.folder, call.settings, call.told.quiet);
  write_file(call.output, video.bytes);
  if (!call.told.quiet)
    fmt::print("{}: {:.1f} MB, {} frames of {} x {} pixels, {}\n", call.output,
               1e-6 * static_cast<double>(video.bytes.size()), video.frames, call.settings.width,
               call.settings.height, video.codec);
  return kGood;
}

}  // namespace

void check_video(const std::string& file) {
  if (std::filesystem::path(file).extension() != ".mp4")
    throw InputError(file + ": does not end in .mp4, by which players know it");
  check_writable(file);
}

report::Video video_of(const std::filesystem::path& folder, const report::VideoSettings& settings,
                       bool quiet) {
  const report::RecordedRehearsal recorded = report::read_recorded_rehearsal(folder);
  const report::RecordedReplay replay = report::read_recorded_replay(folder);
  ProgressLine line(!quiet, {"frames", static_cast<double>(report::frame_times(replay, settings).size())});
  return report::replay_video(replay, recorded, settings, line.teller());
}

void add_export_video(CLI::App& command, Action& action) {
  auto call = std::make_shared<VideoCall>();
  auto* video = command.add_subcommand(
      "video", "A rehearsal as a film: machine, growing beads, and what was found, as it happens");
  video->footer(
      "Example: understudy rehearse part.gcode --out part && understudy export video part -o part.mp4\n"
      "A frame takes one to two seconds: fewer of them, and smaller ones, are drawn sooner "
      "(docs/viewers.md).");
  video->add_option("folder", call->folder, "results of understudy rehearse")->required();
  video->add_option("--seconds", call->settings.duration, "length of the film")->capture_default_str();
  video->add_option("--fps", call->settings.frames_per_second, "frames per second")->capture_default_str();
  video->add_option("--size", call->size, "of a frame in pixels, 1280x720 unless given");
  add_quiet_option(*video, call->told, "no progress, and no word");
  video->add_option("-o,--output", call->output, "file to write, FILE.mp4")->required();
  video->callback([=, &action] { action = [=] { return export_video(*call); }; });
}

}  // namespace understudy::cli
