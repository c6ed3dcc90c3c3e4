#include "rehearsal/placement/path_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "toolpath/gcode/rewrite/turned_program.h"

namespace understudy::rehearsal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Place, axis and turn of the tool in one space: turning by a radian is as far as a third of the print.
using Features = Eigen::Matrix<double, 9, 1>;
constexpr double kTurnWeight = 0.3;
constexpr double kRounding = 1e-12;

std::vector<Features> features_of(const std::vector<PathPose>& poses) {
  Vec3 lower = Vec3::Constant(kInfinity), upper = -lower;
  for (const PathPose& pose : poses) {
    lower = lower.cwiseMin(pose.X_WT.translation());
    upper = upper.cwiseMax(pose.X_WT.translation());
  }
  const double size = std::max((upper - lower).norm(), 1e-6);
  std::vector<Features> all;
  all.reserve(poses.size());
  for (const PathPose& pose : poses) {
    Features f;
    f << pose.X_WT.translation() / size, kTurnWeight * pose.X_WT.linear().col(2),
        kTurnWeight * pose.X_WT.linear().col(0);
    all.push_back(f);
  }
  return all;
}

/// Outermost along the axes and the diagonals between them.
std::vector<std::size_t> outermost(const std::vector<PathPose>& poses) {
  std::vector<std::size_t> found;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 along = Vec3(x, y, z);
        const auto further = [&](const PathPose& a, const PathPose& b) {
          return along.dot(a.X_WT.translation()) < along.dot(b.X_WT.translation());
        };
        found.push_back(
            static_cast<std::size_t>(std::max_element(poses.begin(), poses.end(), further) - poses.begin()));
      }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

double cross(const Vec3& o, const Vec3& a, const Vec3& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

/// Its place is not the program's to say. Arcs that begin at home may have other numbers of chords: then
/// every step counts as the program's.
bool follows_home(const toolpath::Program& program, const toolpath::Program& from_elsewhere, std::size_t i) {
  if (program.steps.size() != from_elsewhere.steps.size()) return false;
  return !from_elsewhere.steps[i].X_WT.isApprox(program.steps[i].X_WT, kRounding);
}

}  // namespace

Vec3 ProgramPath::origin_W(const Stand& stand) const {
  const Vec2 origin = stand.middle - Eigen::Rotation2Dd(stand.turn) * middle();
  return {origin.x(), origin.y(), height};
}

PathPose ProgramPath::placed(const PathPose& pose, const Stand& stand) const {
  PathPose there = pose;
  if (stand.turn != 0 || stand.spin != 0)
    there.X_WT = toolpath::turned_pose(pose.X_WT, Vec3::Zero(), {stand.turn, stand.spin});
  there.X_WT.translation() += origin_W(stand);
  return there;
}

ProgramPath program_path(const toolpath::Program& program, const toolpath::Program& from_elsewhere) {
  ProgramPath path;
  path.lower = Vec2::Constant(kInfinity);
  path.upper = -path.lower;
  path.lowest = kInfinity;
  bool connected = false;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    const toolpath::Step& step = program.steps[i];
    if (step.kind == toolpath::StepKind::end) break;
    if (!toolpath::moves(step)) continue;
    if (step.kind == toolpath::StepKind::home || follows_home(program, from_elsewhere, i)) {
      connected = false;
      continue;
    }
    const bool prints = step.kind == toolpath::StepKind::print;
    const Vec3& p = step.X_WT.translation();
    if (prints) {
      if (connected) path.poses.back().prints = true;
      path.lower = path.lower.cwiseMin(p.head<2>());
      path.upper = path.upper.cwiseMax(p.head<2>());
      path.lowest = std::min(path.lowest, p.z());
    }
    path.poses.push_back({step.X_WT, step.rotary, step.line, prints});
    path.connected.push_back(connected);
    if (step.rotary && path.poses.front().turns)
      path.turns = path.turns || step.rotary->b != path.poses.front().turns->b ||
                   step.rotary->c != path.poses.front().turns->c;
    connected = true;
  }
  if (path.lowest == kInfinity) throw InputError(program.file + ": prints nothing, so its place is free");
  for (const PathPose& pose : path.poses) {  // where beads begin
    if (!pose.prints) continue;
    path.lower = path.lower.cwiseMin(pose.X_WT.translation().head<2>());
    path.upper = path.upper.cwiseMax(pose.X_WT.translation().head<2>());
  }
  return path;
}

std::vector<std::size_t> spread_poses(const std::vector<PathPose>& poses, std::size_t count) {
  std::vector<std::size_t> chosen = outermost(poses);
  const std::vector<Features> features = features_of(poses);
  std::vector<double> nearest(poses.size(), kInfinity);
  const auto note = [&](std::size_t i) {
    for (std::size_t k = 0; k < poses.size(); ++k)
      nearest[k] = std::min(nearest[k], (features[k] - features[i]).squaredNorm());
  };
  for (const std::size_t i : chosen) note(i);
  while (chosen.size() < count) {
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    if (*farthest <= 0) break;
    chosen.push_back(static_cast<std::size_t>(farthest - nearest.begin()));
    note(chosen.back());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<std::size_t> printed_hull(const std::vector<PathPose>& poses) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (poses[i].prints) order.push_back(i);
  const auto at = [&](std::size_t i) -> Vec3 { return poses[i].X_WT.translation(); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return at(a).x() != at(b).x() ? at(a).x() < at(b).x() : at(a).y() < at(b).y();
  });
  std::vector<std::size_t> hull;
  for (int side = 0; side < 2; ++side) {  // Andrew's monotone chain
    const std::size_t begun = hull.size();
    for (const std::size_t i : order) {
      while (hull.size() >= begun + 2 && cross(at(hull[hull.size() - 2]), at(hull.back()), at(i)) <= 0)
        hull.pop_back();
      hull.push_back(i);
    }
    if (hull.size() > begun + 1) hull.pop_back();
    std::reverse(order.begin(), order.end());
  }
  std::sort(hull.begin(), hull.end());
  hull.erase(std::unique(hull.begin(), hull.end()), hull.end());
  return hull;
}

}  // namespace understudy::rehearsal
