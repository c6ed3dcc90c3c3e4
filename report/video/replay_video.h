// A rehearsal as a film.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "report/page/recorded_replay.h"
#include "report/recorded/recorded_rehearsal.h"

namespace understudy::report {

struct VideoSettings {
  double duration = 15;            ///< [s], 0.2 to 600
  double frames_per_second = 10;   ///< 1 to 60
  int width = 1280, height = 720;  ///< [px], even, 320 to 4096
};

struct Video {
  std::string bytes;  ///< of an .mp4
  std::string codec;  ///< "H.264", or "MPEG-4" where this computer has no encoder of H.264
  int frames = 0;
};

/// The instants [s] of the frames, evenly over the run: the first at its begin, the last at its end.
std::vector<double> frame_times(const RecordedReplay& replay, const VideoSettings& settings);

/// Machine at the left, the print from close by at the right, below what was found, each from its instant on.
/// Throws InputError for settings outside their ranges, MachineError where nothing can be drawn or encoded.
/// Findings and lines are those of `recorded`, of the same folder.
Video replay_video(const RecordedReplay& replay, const RecordedRehearsal& recorded,
                   const VideoSettings& settings, const Progress& progress = {});

}  // namespace understudy::report
