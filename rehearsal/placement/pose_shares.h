// How far one pose of a machine is from each of its limits, as shares (placement.h).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "kinematics/mechanism.h"
#include "machine/description.h"
#include "sim/collision/body_set.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// A pose of a program.
struct PathPose {
  Pose X_WT = Pose::Identity();
  std::optional<toolpath::RotaryTurns> turns;
  int line = 0;
  bool prints = false;  ///< a bead begins or ends here
};

class PoseShares {
 public:
  /// The obstacle may be null.
  PoseShares(const machine::MachineDescription& machine, std::shared_ptr<const geometry::Mesh> obstacle);

  // The limits, in order: reach, those of the kinematics, edge of the table, clearance.
  std::size_t size() const { return names_.size(); }
  const std::string& name(std::size_t limit) const { return names_[limit]; }
  std::size_t edge() const { return names_.size() - 2; }
  std::size_t clearance() const { return names_.size() - 1; }
  static constexpr std::size_t kReach = 0;

  const kinematics::Mechanism& mechanism() const { return *mechanism_; }
  kinematics::AxisVector home_axes() const;

  /// On the way of a move, at the share `t` of it. A move of rotary words turns its axes evenly.
  PathPose interpolated(const PathPose& from, const PathPose& to, double t) const;

  /// `axes` holds near ones on entry.
  kinematics::SolveStatus solve(const PathPose& pose, kinematics::AxisVector& axes) const;
  /// Of all limits but clearance, into `shares`; reach is 1 here.
  void fill(const PathPose& pose, const kinematics::AxisVector& axes, std::span<double> shares) const;
  double edge_share(const Vec3& p_W) const;

  /// The least clearance along a path: bodies that cannot have come near since they were looked at last are
  /// passed over. Returns the share at this pose where it is below `least`, else `least` or more.
  double clearance_below(double least, const PathPose& pose, const kinematics::AxisVector& axes);
  void begin_path() { last_.reset(); }

  /// "axis x is 251.0 mm, longer than 250.0 mm": how a pose breaks this limit.
  std::string broken(std::size_t limit, const PathPose& pose, const kinematics::AxisVector& axes);

 private:
  double edge_distance(const Vec3& p_W) const;
  std::string nearest_pair(const PathPose& pose, const kinematics::AxisVector& axes);

  machine::MachineDescription machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  std::vector<std::string> names_;
  std::vector<int> axes_with_ends_;  // of a chain
  std::vector<kinematics::AxisRange> ranges_;
  double condition_max_ = 0;
  Pose X_BW_;
  sim::BodySet bodies_;
  std::vector<sim::BodyPair> pairs_;  // that may not meet
  struct Watched {
    double distance = 0, moved = 0;  // [m], at the last look, and since
  };
  std::vector<Watched> watched_;
  std::optional<sim::Configuration> last_;
};

}  // namespace understudy::rehearsal
