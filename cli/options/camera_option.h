// The camera that a word of the command line names: folder:DIR, v4l2:/dev/videoN, http://...
#pragma once

#include <memory>
#include <string>

#include "drivers/camera/frame_source.h"

namespace understudy::cli {

/// Throws InputError for a word that names no kind of camera, and for a camera that is not there.
///
/// folder: pictures that something else writes, under their final names or renamed to them. A name of digits
/// and a point is the time of exposure, in seconds since 1970; else the time when the file was written is.
/// v4l2: the driver's stamps. http: a stream of JPEGs (MJPEG), stamped when each has come.
std::unique_ptr<drivers::FrameSource> open_camera(const std::string& word);

}  // namespace understudy::cli
