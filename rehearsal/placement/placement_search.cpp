#include "rehearsal/placement/placement_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/interrupt.h"
#include "rehearsal/placement/checked_path.h"
#include "rehearsal/placement/placement.h"

namespace understudy::rehearsal {
namespace {

constexpr std::size_t kSamples = 96;
constexpr double kSame = 1e-6;          // shares that are no nearer to each other are told apart
constexpr double kSmallestStep = 1e-6;  // [m]
constexpr int kMovesAtOnce = 8;         // of a step's size, before it is halved
constexpr int kHopeless = 12;           // poses out of reach: the others need no look

std::vector<PathPose> with_poses_between(const PoseShares& shares, const ProgramPath& path) {
  std::vector<PathPose> all;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const int parts = path.connected[i] ? parts_between(path.poses[i - 1], path.poses[i]) : 1;
    for (int k = 1; k < parts; ++k)
      all.push_back(shares.interpolated(path.poses[i - 1], path.poses[i], static_cast<double>(k) / parts));
    all.push_back(path.poses[i]);
  }
  return all;
}

}  // namespace

PlacementSearch::PlacementSearch(PoseShares& shares, const ProgramPath& path, const Vec2& lower,
                                 const Vec2& upper)
    : shares_(shares),
      path_(path),
      lower_(lower),
      upper_(upper),
      home_(shares.home_axes()),
      best_(shares.size(), -std::numeric_limits<double>::infinity()),
      lowest_(shares.size(), std::numeric_limits<double>::infinity()),
      counts_(shares.size(), true) {
  const std::vector<PathPose> poses = with_poses_between(shares, path);
  for (const std::size_t i : spread_poses(poses, kSamples)) samples_.push_back(poses[i]);
  for (const std::size_t i : printed_hull(path.poses)) hull_.push_back(path.poses[i]);
}

Vec2 PlacementSearch::grid_point(int column, int row, int columns, int rows) const {
  const auto along = [](double low, double high, int i, int count) {
    return count > 1 ? low + (high - low) * i / (count - 1) : (low + high) / 2;
  };
  return {along(lower_.x(), upper_.x(), column, columns), along(lower_.y(), upper_.y(), row, rows)};
}

std::vector<Candidate> PlacementSearch::grid(int columns, int rows, double turn, double spin,
                                             const std::function<void(double)>& progress) {
  std::vector<Candidate> all;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      all.push_back(look({grid_point(column, row, columns, rows), turn, spin}));
    if (progress) progress(static_cast<double>(row + 1) / rows);
  }
  return all;
}

void PlacementSearch::settle_counts() {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const bool changes = !(best_[i] - lowest_[i] <= kSame) || std::isinf(lowest_[i]);
    counts_[i] = best_[i] < 0 || (best_[i] >= kSmallShare && changes);
  }
}

double PlacementSearch::effective(std::size_t limit, double share) const {
  return counts_[limit] || share < 0 ? share : 1;
}

std::vector<double> PlacementSearch::sorted(const std::vector<double>& shares) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < shares.size(); ++i) all.push_back(effective(i, shares[i]));
  std::sort(all.begin(), all.end());
  return all;
}

std::size_t PlacementSearch::least(const std::vector<double>& shares) const {
  std::size_t least = 0;
  for (std::size_t i = 1; i < shares.size(); ++i)
    if (effective(i, shares[i]) < effective(least, shares[least])) least = i;
  return least;
}

double PlacementSearch::margin(const std::vector<double>& shares) const {
  const std::size_t i = least(shares);
  return effective(i, shares[i]);
}

bool PlacementSearch::better(const Candidate& a, const Candidate& b) const {
  const std::vector<double> of_a = sorted(a.shares), of_b = sorted(b.shares);
  for (std::size_t i = 0; i < of_a.size(); ++i)
    if (std::abs(of_a[i] - of_b[i]) > kSame) return of_a[i] > of_b[i];
  const Vec2 middle = (lower_ + upper_) / 2;
  const double off_a = (a.stand.middle - middle).norm(), off_b = (b.stand.middle - middle).norm();
  if (std::abs(off_a - off_b) > kSmallestStep / 10) return off_a < off_b;
  return std::abs(a.stand.turn) + std::abs(a.stand.spin) < std::abs(b.stand.turn) + std::abs(b.stand.spin);
}

void PlacementSearch::fill_kinematic(const Stand& stand, std::vector<double>& shares) {
  std::vector<double> here(shares.size(), 1.0);
  kinematics::AxisVector axes = home_;
  axes_.assign(samples_.size(), home_);
  int unreached = 0;
  for (std::size_t i = 0; i < samples_.size() && unreached < kHopeless; ++i) {
    const PathPose pose = path_.placed(samples_[i], stand);
    const kinematics::AxisVector before = axes;
    if (shares_.solve(pose, axes) != kinematics::SolveStatus::ok) {
      axes = before;
      ++unreached;
      shares[PoseShares::kReach] = -1 - static_cast<double>(unreached) / static_cast<double>(i + 1);
      continue;
    }
    axes_[i] = axes;
    shares_.fill(pose, axes, here);
    for (std::size_t k = 1; k < shares.size(); ++k) shares[k] = std::min(shares[k], here[k]);
  }
  for (const PathPose& pose : hull_)
    shares[shares_.edge()] =
        std::min(shares[shares_.edge()], shares_.edge_share(path_.placed(pose, stand).X_WT.translation()));
}

std::vector<double> PlacementSearch::shares_at(const Stand& stand) {
  stop_if_interrupted();
  ++looked_at_;
  std::vector<double> shares(shares_.size(), 1.0);
  fill_kinematic(stand, shares);
  if (shares[PoseShares::kReach] < 0) return shares;
  double& clearance = shares[shares_.clearance()];
  shares_.begin_path();
  for (std::size_t i = 0; i < samples_.size(); ++i)
    clearance = shares_.clearance_below(clearance, path_.placed(samples_[i], stand), axes_[i]);
  return shares;
}

Candidate PlacementSearch::look(const Stand& stand) {
  Candidate found{stand, shares_at(stand)};
  const bool reached = found.shares[PoseShares::kReach] >= 0;
  for (std::size_t i = 0; i < best_.size(); ++i)
    if (reached || i != shares_.clearance()) {
      best_[i] = std::max(best_[i], found.shares[i]);
      if (reached) lowest_[i] = std::min(lowest_[i], found.shares[i]);
    }
  return found;
}

Candidate PlacementSearch::refine(const Candidate& from, double step, double turn_step, double spin_step) {
  Candidate best = look(from.stand);
  for (; step >= kSmallestStep; step /= 2, turn_step /= 2, spin_step /= 2) {
    for (int moves = 0; moves < kMovesAtOnce; ++moves) {
      std::vector<Stand> around;
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          if (x != 0 || y != 0) around.push_back(best.stand), around.back().middle += step * Vec2(x, y);
      for (const int side : {-1, 1}) {
        if (turn_step > 0) around.push_back(best.stand), around.back().turn += side * turn_step;
        if (spin_step > 0) around.push_back(best.stand), around.back().spin += side * spin_step;
      }
      const Candidate centre = best;
      for (const Stand& stand : around) {
        if ((stand.middle.array() < lower_.array()).any() || (stand.middle.array() > upper_.array()).any())
          continue;
        if (Candidate next = look(stand); better(next, best)) best = std::move(next);
      }
      if (best.stand.middle == centre.stand.middle && best.stand.turn == centre.stand.turn &&
          best.stand.spin == centre.stand.spin)
        break;
    }
  }
  return best;
}

}  // namespace understudy::rehearsal
