#include "rehearsal/placement/checked_path.h"

#include <algorithm>
#include <cmath>

#include "core/interrupt.h"

namespace understudy::rehearsal {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;

class Walk {
 public:
  Walk(PoseShares& shares, const ProgramPath& path, const Stand& stand)
      : shares_(shares), path_(path), stand_(stand), axes_(shares.home_axes()), here_(shares.size(), 1.0) {
    found_.shares.assign(shares.size(), 1.0);
    found_.worst.assign(shares.size(), {path.poses.front(), axes_});
    shares_.begin_path();
  }

  CheckedPath run() {
    for (std::size_t i = 0; i < path_.poses.size(); ++i) {
      if (i % 256 == 0) stop_if_interrupted();
      if (path_.connected[i])
        between(path_.poses[i - 1], path_.poses[i]);
      else
        look(path_.poses[i]);
    }
    if (unreached_ > 0)
      found_.shares[PoseShares::kReach] =
          -1 - static_cast<double>(unreached_) / static_cast<double>(found_.poses);
    return std::move(found_);
  }

 private:
  void between(const PathPose& from, const PathPose& to) {
    const int parts = parts_between(from, to);
    for (int k = 1; k < parts; ++k) look(shares_.interpolated(from, to, static_cast<double>(k) / parts));
    look(to);
  }

  void look(const PathPose& pose) {
    ++found_.poses;
    const PathPose there = path_.placed(pose, stand_);
    const AxisVector before = axes_;
    if (shares_.solve(there, axes_) != SolveStatus::ok) {
      axes_ = before;
      if (unreached_++ == 0) found_.worst[PoseShares::kReach] = {pose, axes_};
      return;
    }
    shares_.fill(there, axes_, here_);
    for (std::size_t i = 1; i < shares_.clearance(); ++i) note(i, here_[i], pose);
    note(shares_.clearance(), shares_.clearance_below(found_.shares[shares_.clearance()], there, axes_),
         pose);
  }

  void note(std::size_t limit, double share, const PathPose& pose) {
    if (share >= found_.shares[limit]) return;
    found_.shares[limit] = share;
    found_.worst[limit] = {pose, axes_};
  }

  PoseShares& shares_;
  const ProgramPath& path_;
  Stand stand_;
  AxisVector axes_;
  std::vector<double> here_;
  int unreached_ = 0;
  CheckedPath found_;
};

}  // namespace

int parts_between(const PathPose& from, const PathPose& to) {
  const double way = (to.X_WT.translation() - from.X_WT.translation()).norm();
  double turn = angle_between(from.X_WT.linear(), to.X_WT.linear());
  if (from.turns && to.turns)
    turn = std::max({turn, std::abs(to.turns->b - from.turns->b), std::abs(to.turns->c - from.turns->c)});
  return std::max(1, static_cast<int>(std::ceil(std::max(way / kPathStep, turn / kPathTurn))));
}

CheckedPath check_path(PoseShares& shares, const ProgramPath& path, const Stand& stand) {
  return Walk(shares, path, stand).run();
}

}  // namespace understudy::rehearsal
