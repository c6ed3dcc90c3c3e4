// The poses of a program that go where its place goes, and a few of them that stand for all.
#pragma once

#include <vector>

#include "core/frames.h"
#include "rehearsal/placement/pose_shares.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// Where the print stands and how it is turned.
struct Stand {
  Vec2 middle{0, 0};          ///< [m], of what it prints, seen from above, in W
  double turn = 0, spin = 0;  ///< [rad] (toolpath/gcode/rewrite/turned_program.h)
};

struct ProgramPath {
  std::vector<PathPose> poses;    ///< in the frame of the program, in order
  std::vector<bool> connected;    ///< the way leads here from the pose before
  Vec2 lower{0, 0}, upper{0, 0};  ///< [m], of what is printed
  double lowest = 0;              ///< [m], z of the lowest printed point
  bool turns = false;             ///< it states rotary words that turn
  double height = 0;              ///< [m], that every pose is lifted by

  Vec2 middle() const { return (lower + upper) / 2; }
  /// [m], the program's origin in W.
  Vec3 origin_W(const Stand& stand) const;
  PathPose placed(const PathPose& pose, const Stand& stand) const;
};

/// Of a program that was read with its origin at W's. Left out: home, and what a program leaves to where home
/// is, which `from_elsewhere` shows: the same program, read for another home. Throws InputError for a program
/// that prints nothing.
ProgramPath program_path(const toolpath::Program& program, const toolpath::Program& from_elsewhere);

/// Numbers of `count` poses at most, in order, far from each other in place and orientation; among them the
/// outermost. The same for equal paths.
std::vector<std::size_t> spread_poses(const std::vector<PathPose>& poses, std::size_t count);

/// Numbers of the printed poses on the convex hull of what is printed, seen from above.
std::vector<std::size_t> printed_hull(const std::vector<PathPose>& poses);

}  // namespace understudy::rehearsal
