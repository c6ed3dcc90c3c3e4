#include "toolpath/lattice/lattice_access.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kTiltStep = 15 * kDegree;
constexpr int kAzimuths = 24;
constexpr double kRounding = 1e-9;               // [m]
constexpr double kTolerance = 50 * kMicrometre;  // of distances that only rank axes

}  // namespace

std::vector<Vec3> tool_axes(double tilt_max) {
  std::vector<Vec3> axes = {Vec3::UnitZ()};
  for (int i = 1; i * kTiltStep <= tilt_max + 1e-9; ++i)
    for (int k = 0; k < kAzimuths; ++k) {
      const double tilt = i * kTiltStep, azimuth = 2 * std::numbers::pi * k / kAzimuths;
      axes.emplace_back(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                        std::cos(tilt));
    }
  return axes;
}

StrutAccess::StrutAccess(const Lattice& lattice, const SequenceLimits& limits)
    : lattice_(lattice), limits_(limits), tool_(limits.tool), axes_(tool_axes(limits.tilt_max)) {}

Vec3 StrutAccess::tip(int node, const Vec3& axis) const {
  return tip_at(lattice_.nodes[node], axis, limits_.strut_diameter, limits_.ground_gap);
}

StrutPrint StrutAccess::print_along(int strut, int from, int to, const Vec3& axis,
                                    const std::vector<int>& built) const {
  StrutPrint print{strut, from, to, axis};
  // Beyond the plane across the axis that everything built lies below.
  double level = -std::numeric_limits<double>::infinity();
  const auto raise = [&](int s) {
    for (const int node : lattice_.struts[s])
      level = std::max(level, axis.dot(lattice_.nodes[node].position) + 0.5 * limits_.strut_diameter);
  };
  for (const int s : built) raise(s);
  print.out_from = limits_.lift + std::max(0.0, level - axis.dot(tip(from, axis)));
  raise(strut);
  print.out_to = limits_.lift + std::max(0.0, level - axis.dot(tip(to, axis)));
  return print;
}

bool StrutAccess::allowed(const StrutPrint& print) const {
  const Vec3 from = tip(print.from, print.axis), to = tip(print.to, print.axis);
  if (std::min(from.z(), to.z()) + tool_.lowest(print.axis) < -kRounding) return false;
  if (!limits_.reachable) return true;
  const auto reachable = [&](const Vec3& p, double out) {
    return limits_.reachable(tool_at(p, print.axis, out));
  };
  return reachable(from, 0) && reachable(to, 0) && reachable(0.5 * (from + to), 0) &&
         reachable(from, print.out_from) && reachable(to, print.out_to);
}

StrutBody StrutAccess::body(int strut, const StrutPrint& print) const {
  const auto& [a, b] = lattice_.struts[strut];
  StrutBody body{lattice_.nodes[a].position, lattice_.nodes[b].position, 0.5 * limits_.strut_diameter};
  const Vec3 along = body.to - body.from;
  const Vec3 joint = std::min(1.0, limits_.joint / along.norm()) * along;
  if (a == print.from || a == print.to) body.from += joint;
  if (b == print.from || b == print.to) body.to -= joint;
  if ((body.to - body.from).dot(along) < 0) body.from = body.to = 0.5 * (body.from + body.to);
  return body;
}

StrutBody StrutAccess::fresh(const StrutPrint& print) const {
  const Vec3 from = lattice_.nodes[print.from].position, to = lattice_.nodes[print.to].position;
  const Vec3 along = to - from;
  return {from, to - std::min(1.0, limits_.joint / along.norm()) * along, 0.5 * limits_.strut_diameter};
}

std::vector<ToolMotion> StrutAccess::motions(const StrutPrint& print) const {
  const Vec3 from = tip(print.from, print.axis), to = tip(print.to, print.axis);
  return {{from + print.out_from * print.axis, from, print.axis}, {from, to, print.axis}, leaving(print)};
}

ToolMotion StrutAccess::leaving(const StrutPrint& print) const {
  const Vec3 to = tip(print.to, print.axis);
  return {to, to + print.out_to * print.axis, print.axis};
}

bool StrutAccess::find(int strut, int from, int to, const std::vector<int>& built, StrutPrint& print) const {
  for (const Vec3& axis : axes_) {
    print = print_along(strut, from, to, axis, built);
    // What is printed hangs from the tip: later stages of the strut hold the earlier ones.
    if (!tool_.clears(fresh(print), leaving(print), limits_.margin)) continue;
    const auto paths = motions(print);
    const bool clear = std::all_of(built.begin(), built.end(), [&](int other) {
      const StrutBody obstacle = body(other, print);
      return std::all_of(paths.begin(), paths.end(), [&](const ToolMotion& path) {
        return tool_.clears(obstacle, path, limits_.margin);
      });
    });
    if (clear && allowed(print)) return true;
  }
  return false;
}

StrutAccess::Obstacle StrutAccess::clearest(int strut, int from, int to, const std::vector<int>& built,
                                            StrutPrint& best) const {
  Obstacle answer{-std::numeric_limits<double>::infinity(), -1};
  for (const Vec3& axis : axes_) {
    const StrutPrint print = print_along(strut, from, to, axis, built);
    if (!allowed(print)) continue;
    Obstacle nearest{tool_.distance(fresh(print), leaving(print), kTolerance), strut};
    const auto paths = motions(print);
    for (const int other : built) {
      for (const ToolMotion& path : paths) {
        if (tool_.clears(body(other, print), path, nearest.distance)) continue;
        const double distance = tool_.distance(body(other, print), path, kTolerance);
        if (distance < nearest.distance) nearest = {distance, other};
      }
      if (nearest.distance <= answer.distance) break;
    }
    if (nearest.distance <= answer.distance) continue;
    answer = nearest;
    best = print;
  }
  return answer;
}

}  // namespace understudy::toolpath
