// The search over places: a grid over the table on some poses of the path, then ever smaller steps from the
// best points. Whether every pose holds is checked_path.h's to say; what it finds is added to the poses.
#pragma once

#include <functional>
#include <vector>

#include "rehearsal/placement/path_poses.h"
#include "rehearsal/placement/pose_shares.h"

namespace understudy::rehearsal {

/// A place that was looked at.
struct Candidate {
  Stand stand;
  std::vector<double> shares;  ///< by limit; clearance is 1 where poses are out of reach
};

class PlacementSearch {
 public:
  /// `lower` and `upper` [m]: where the middle of the print may stand.
  PlacementSearch(PoseShares& shares, const ProgramPath& path, const Vec2& lower, const Vec2& upper);

  /// Column by column of each row. Settles which limits count.
  std::vector<Candidate> grid(int columns, int rows, double turn, double spin,
                              const std::function<void(double)>& progress);
  Vec2 grid_point(int column, int row, int columns, int rows) const;

  /// The best of the grids' points, then by steps that are halved from `step` [m] and `turn_step` [rad] down
  /// to a micrometre. With 0 for `turn_step` turn and spin stay.
  Candidate refine(const Candidate& from, double step, double turn_step, double spin_step);

  Candidate look(const Stand& stand);
  void add_sample(const PathPose& pose) { samples_.push_back(pose); }

  /// The least share of limits that count; below 0 also where one of the others is broken.
  double margin(const std::vector<double>& shares) const;
  std::size_t least(const std::vector<double>& shares) const;
  /// Has the larger margin; of equal ones, the larger share of the limit next to it, and so on; then stands
  /// nearer to the middle of the table.
  bool better(const Candidate& a, const Candidate& b) const;

  const std::vector<double>& best_shares() const { return best_; }
  bool counts(std::size_t limit) const { return counts_[limit]; }
  void settle_counts();
  int looked_at() const { return looked_at_; }
  std::size_t samples() const { return samples_.size(); }

 private:
  double effective(std::size_t limit, double share) const;
  std::vector<double> sorted(const std::vector<double>& shares) const;
  void fill_kinematic(const Stand& stand, std::vector<double>& shares);
  std::vector<double> shares_at(const Stand& stand);

  PoseShares& shares_;
  const ProgramPath& path_;
  Vec2 lower_, upper_;
  std::vector<PathPose> samples_;  // in the frame of the program
  std::vector<PathPose> hull_;
  kinematics::AxisVector home_;
  std::vector<kinematics::AxisVector> axes_;  // of the samples, at the last look
  std::vector<double> best_, lowest_;         // of the places looked at, the latter where all can be reached
  std::vector<bool> counts_;
  int looked_at_ = 0;
};

}  // namespace understudy::rehearsal
