#include "rehearsal/placement/pose_shares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "rehearsal/placement/placement.h"
#include "sim/as_built/as_built.h"

namespace understudy::rehearsal {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;

constexpr const char* kHexapodLimits[] = {"struts", "base joints", "base joints (lateral)", "ball joints",
                                          "screws"};

double between(double value, double lower, double upper) {
  return 2 * std::min(value - lower, upper - value) / (upper - lower);
}

/// In the order of kHexapodLimits.
void hexapod_shares(const machine::HexapodModel& hexapod, const Pose& X_BT, const AxisVector& lengths,
                    std::span<double> shares) {
  const auto& limits = hexapod.limits;
  std::fill(shares.begin(), shares.end(), 1.0);
  const auto lower = [&](std::size_t i, double share) { shares[i] = std::min(shares[i], share); };
  for (int i = 0; i < kinematics::kStruts; ++i) {
    lower(0, between(lengths[static_cast<std::size_t>(i)], limits.strut_min, limits.strut_max));
    const auto angles = kinematics::strut_angles(hexapod.geometry, hexapod.joints, X_BT, i);
    lower(1, between(angles.alpha, limits.base_alpha_min, limits.base_alpha_max));
    lower(2, between(angles.beta, -limits.base_beta_max, limits.base_beta_max));
    lower(3, between(angles.ball, limits.ball_min, limits.ball_max));
    for (int j = i + 1; j < kinematics::kStruts; ++j)
      lower(4, kinematics::screw_distance(hexapod.geometry, X_BT, i, j) / limits.screw_distance_min - 1);
  }
}

double condition_limit(const machine::MachineDescription& machine) {
  const double stated =
      machine.visit([](const machine::HexapodModel& hexapod) { return hexapod.limits.condition_max; },
                    [](const machine::ChainModel& chain) { return chain.kinematics.condition_max; });
  return std::min(stated, kConditionFar);
}

}  // namespace

PoseShares::PoseShares(const machine::MachineDescription& machine,
                       std::shared_ptr<const geometry::Mesh> obstacle)
    : machine_(machine),
      mechanism_(machine_.make_mechanism()),
      condition_max_(condition_limit(machine)),
      X_BW_(machine.X_WB.inverse()),
      bodies_(machine, sim::as_described(machine), std::move(obstacle), nullptr) {
  names_.emplace_back("reach");
  if (machine.is_chain()) {
    for (int i = 0; i < mechanism_->axis_count(); ++i) {
      const kinematics::AxisRange range = mechanism_->axis_range(i);
      if (!std::isfinite(range.lower) || !std::isfinite(range.upper) || range.upper <= range.lower) continue;
      axes_with_ends_.push_back(i);
      ranges_.push_back(range);
      names_.push_back("axis " + mechanism_->axis_name(i));
    }
  } else {
    names_.insert(names_.end(), std::begin(kHexapodLimits), std::end(kHexapodLimits));
  }
  if (mechanism_->follows_spin()) names_.emplace_back("singular posture");
  names_.emplace_back("table edge");
  names_.emplace_back("clearance");
  // The nozzle over the table is the work; over a fixture it is not.
  for (const sim::BodyPair& pair : bodies_.pairs())
    if (!pair.printed && !(pair.nozzle_at_work && bodies_.name(pair.obstacle) == "table"))
      pairs_.push_back(pair);
  watched_.resize(pairs_.size());
}

AxisVector PoseShares::home_axes() const {
  AxisVector axes{};
  // The reader of the description has made sure of it.
  static_cast<void>(mechanism_->inverse(machine_.X_BT_home, {}, axes));
  return axes;
}

PathPose PoseShares::interpolated(const PathPose& from, const PathPose& to, double t) const {
  PathPose pose{interpolate(from.X_WT, to.X_WT, t), std::nullopt, to.line, from.prints && to.prints};
  if (!from.turns || !to.turns) return pose;
  pose.turns = {from.turns->b + t * (to.turns->b - from.turns->b),
                from.turns->c + t * (to.turns->c - from.turns->c)};
  Pose X_BT = X_BW_ * pose.X_WT;
  if (mechanism_->pose_at_turns({X_BT.translation(), pose.turns->b, pose.turns->c}, X_BT) == SolveStatus::ok)
    pose.X_WT = machine_.X_WB * X_BT;
  return pose;
}

SolveStatus PoseShares::solve(const PathPose& pose, AxisVector& axes) const {
  const auto count = static_cast<std::size_t>(mechanism_->axis_count());
  const Pose X_BT = X_BW_ * pose.X_WT;
  const AxisVector before = axes;
  if (!pose.turns)
    return mechanism_->inverse(X_BT, std::span(before).first(count), std::span(axes).first(count));
  AxisVector rates{};
  return mechanism_->axes_at_turns({X_BT.translation(), pose.turns->b, pose.turns->c}, {},
                                   std::span(axes).first(count), std::span(rates).first(count));
}

void PoseShares::fill(const PathPose& pose, const AxisVector& axes, std::span<double> shares) const {
  const Pose X_BT = X_BW_ * pose.X_WT;
  shares[kReach] = 1;
  std::size_t next = 1;
  for (std::size_t i = 0; i < axes_with_ends_.size(); ++i, ++next)
    shares[next] =
        between(axes[static_cast<std::size_t>(axes_with_ends_[i])], ranges_[i].lower, ranges_[i].upper);
  if (!machine_.is_chain()) {
    constexpr std::size_t kCount = std::size(kHexapodLimits);
    hexapod_shares(machine_.hexapod(), X_BT, axes, shares.subspan(next, kCount));
    next += kCount;
  }
  if (mechanism_->follows_spin()) {
    const auto count = static_cast<std::size_t>(mechanism_->axis_count());
    const double condition = mechanism_->condition_number(X_BT, std::span(axes).first(count));
    shares[next] = 1 - std::log(condition) / std::log(condition_max_);
  }
  shares[edge()] = pose.prints ? edge_share(pose.X_WT.translation()) : 1;
}

/// [m], inwards; infinity for a table that is no block.
double PoseShares::edge_distance(const Vec3& p_W) const {
  const auto* block = std::get_if<geometry::Box>(&machine_.table.form);
  if (block == nullptr) return std::numeric_limits<double>::infinity();
  const Vec3 p = machine_.table.X_FS.inverse() * p_W;
  return std::min(block->size.x() / 2 - std::abs(p.x()), block->size.y() / 2 - std::abs(p.y()));
}

double PoseShares::edge_share(const Vec3& p_W) const {
  return std::min(1.0, edge_distance(p_W) / kEnoughClearance);
}

double PoseShares::clearance_below(double least, const PathPose& pose, const AxisVector& axes) {
  const sim::Configuration here{pose.X_WT, axes};
  sim::BodySet::Travel travel;
  if (last_) {
    travel.path = (here.X_WT.translation() - last_->X_WT.translation()).norm();
    travel.turn = angle_between(here.X_WT.linear(), last_->X_WT.linear());
    for (std::size_t i = 0; i < axes.size(); ++i) travel.axes[i] = std::abs(axes[i] - last_->axes[i]);
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Watched& seen = watched_[i];
    if (last_) seen.moved += bodies_.motion(pairs_[i], travel);
    if (last_ && seen.distance - seen.moved >= least * kEnoughClearance) continue;
    seen = {bodies_.separation(pairs_[i], here, true).distance, 0};
    least = std::min(least, seen.distance / kEnoughClearance);
  }
  last_ = here;
  return least;
}

std::string PoseShares::nearest_pair(const PathPose& pose, const AxisVector& axes) {
  double least = std::numeric_limits<double>::infinity();
  std::string text;
  for (const sim::BodyPair& pair : pairs_) {
    const double distance = bodies_.separation(pair, {pose.X_WT, axes}, true).distance;
    if (distance >= least) continue;
    least = distance;
    text = fmt::format("{} {} {}", bodies_.name(pair.body),
                       distance > 0 ? fmt::format("comes within {:.3f} mm of", to_mm(distance))
                                    : fmt::format("is {:.3f} mm deep in", -to_mm(distance)),
                       bodies_.name(pair.obstacle));
  }
  return text;
}

std::string PoseShares::broken(std::size_t limit, const PathPose& pose, const AxisVector& axes) {
  if (limit == clearance()) return nearest_pair(pose, axes);
  if (limit == edge()) {
    const Vec3 p = 1e3 * pose.X_WT.translation();
    return fmt::format("it prints {:.3f} mm beyond the table's edge, at ({:.3f}, {:.3f})",
                       -to_mm(edge_distance(pose.X_WT.translation())), p.x(), p.y());
  }
  using kinematics::LimitKind;
  const auto kind_of = [&](const kinematics::LimitViolation& violation) {
    switch (violation.kind) {
      case LimitKind::joint_limit:
        return violation.part;
      case LimitKind::strut_length:
        return std::string("struts");
      case LimitKind::joint_angle: {
        const bool ball = violation.part.starts_with("ball"), lateral = violation.part.ends_with("(lateral)");
        return std::string(ball ? "ball joints" : lateral ? "base joints (lateral)" : "base joints");
      }
      case LimitKind::screw_distance:
        return std::string("screws");
      case LimitKind::singularity:
        return std::string("singular posture");
      default:
        return std::string("reach");
    }
  };
  std::vector<kinematics::LimitViolation> all;
  const auto count = static_cast<std::size_t>(mechanism_->axis_count());
  mechanism_->check(X_BW_ * pose.X_WT, std::span(axes).first(limit == kReach ? 0 : count), all);
  const kinematics::LimitViolation* worst = nullptr;
  for (const auto& violation : all)
    if (kind_of(violation) == name(limit) &&
        (worst == nullptr ||
         std::abs(violation.value - violation.limit) > std::abs(worst->value - worst->limit)))
      worst = &violation;
  if (worst != nullptr) return to_string(*worst);
  const Vec3 p = 1e3 * pose.X_WT.translation();
  return fmt::format("{} at ({:.3f}, {:.3f}, {:.3f})",
                     limit == kReach ? "the machine cannot reach the tip" : name(limit), p.x(), p.y(), p.z());
}

}  // namespace understudy::rehearsal
