// Every pose of a path at one place, and the poses between them, against every limit.
#pragma once

#include <vector>

#include "rehearsal/placement/path_poses.h"
#include "rehearsal/placement/pose_shares.h"

namespace understudy::rehearsal {

constexpr double kPathStep = 5e-3;    ///< [m], at most between two poses that are looked at
constexpr double kPathTurn = 0.0873;  ///< [rad], 5 degrees

/// Into how many parts a move is divided for that; 1 at least.
int parts_between(const PathPose& from, const PathPose& to);

struct CheckedPath {
  struct Worst {
    PathPose pose;                  ///< in the frame of the program
    kinematics::AxisVector axes{};  ///< there; of a pose out of reach, the ones before
  };
  std::vector<double> shares;  ///< by limit, least along the path
  std::vector<Worst> worst;    ///< by limit
  int poses = 0;
};

/// Throws Interrupted when the user stops it.
CheckedPath check_path(PoseShares& shares, const ProgramPath& path, const Stand& stand);

}  // namespace understudy::rehearsal
