// The picture files of a measuring set-up: which camera, layer and pose each shows, by its name.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "vision/boards/chessboard.h"
#include "vision/boards/rig_file.h"
#include "vision/boards/rig_measurement.h"

namespace understudy::vision {

struct BoardPicture {
  std::string file;
  int camera = 0;
  int layer = 0;
};

/// Of `files`, by their names; of none, all that the set-up has. In the order of camera and layer. Throws
/// InputError: a name that does not fit rig.board_pictures, a camera or layer that the set-up has not, one
/// picture given twice.
std::vector<BoardPicture> board_pictures(const RigDescription& description,
                                         const std::vector<std::string>& files);

struct PosePicture {
  std::string file;
  int pose = 0;  ///< its number, from 1
  int camera = 0;
};

/// In the order of pose and camera. Throws InputError: a name that does not fit rig.pose_pictures, pose 0, a
/// camera that the set-up has not, one picture given twice.
std::vector<PosePicture> pose_pictures(const RigDescription& description,
                                       const std::vector<std::string>& files);

/// Both pictures of each pose. Throws InputError as pose_pictures, and for a picture whose partner is
/// missing.
std::vector<std::array<PosePicture, 2>> pose_picture_pairs(const RigDescription& description,
                                                           const std::vector<std::string>& files);

/// The whole picture of a camera. Throws InputError as read_picture, and for a size that is not the sensor's.
Image read_rig_picture(const RigDescription& description, int camera, const std::string& file);

/// A board with what was seen of it.
struct MeasuredBoardPicture {
  BoardPicture picture;
  BoardMeasurement seen;
};

/// `done` is called after each picture. Throws as read_rig_picture; what a picture holds is a status.
std::vector<MeasuredBoardPicture> measure_boards(const RigDescription& description,
                                                 const std::vector<BoardPicture>& pictures,
                                                 const std::function<void(std::size_t)>& done = {});

/// Those that were measured, as calibrate_rig takes them.
std::vector<SeenBoard> seen_boards(const std::vector<MeasuredBoardPicture>& boards);

}  // namespace understudy::vision
