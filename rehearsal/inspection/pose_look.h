// One pose of a machine, looked at: its axes, how far they are from their ends, other ways to stand there,
// and what is near.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "kinematics/mechanism.h"
#include "machine/description.h"
#include "sim/collision/configuration.h"

namespace understudy::rehearsal {

/// The pair of bodies that is nearest.
struct NearestPair {
  double distance = 0;  ///< [m]; 0 or less: they overlap
  std::string body, obstacle;
};

struct PoseLook {
  Pose X_WT = Pose::Identity();  ///< that was asked for, or that the axes make
  kinematics::SolveStatus status = kinematics::SolveStatus::ok;
  kinematics::AxisVector axes{};  ///< [m] or [rad]; of status ok
  std::vector<kinematics::LimitViolation> broken;
  /// Other axis positions within the ranges that reach the pose, each differing by more than a turn. Of
  /// machines that have more axes than the pose needs, some.
  std::vector<kinematics::AxisVector> others;
  double condition = 0;  ///< 1 at best; kinematics::kSingularCondition: singular
  /// Nozzle to what it prints on, and all else; nothing where no bodies may meet.
  std::optional<NearestPair> nozzle, nearest;

  /// It can be reached without breaking a limit, and nothing touches.
  bool good() const;
};

/// What one line of a program says: words such as X10 Z5 B20, I J K, W I J K; none: home. `part` may be null.
/// Throws InputError as the reader does.
PoseLook look_at_words(const machine::MachineDescription& machine, const std::string& words,
                       std::shared_ptr<const geometry::Mesh> part);

/// Axis positions [m] or [rad]. Throws InputError where they make no pose.
PoseLook look_at_axes(const machine::MachineDescription& machine, const kinematics::AxisVector& axes,
                      std::shared_ptr<const geometry::Mesh> part);

}  // namespace understudy::rehearsal
