// A rehearsal's folder of results as a film: for `export video` and `rehearse --video`.
#pragma once

#include <filesystem>
#include <string>

#include "report/video/replay_video.h"

namespace understudy::cli {

/// Throws InputError where the name does not end in .mp4 or no file can be written there: before any work.
void check_video(const std::string& file);

/// Progress goes to standard error unless it is to be quiet.
report::Video video_of(const std::filesystem::path& folder, const report::VideoSettings& settings,
                       bool quiet);

}  // namespace understudy::cli
