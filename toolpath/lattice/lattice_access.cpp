#include "toolpath/lattice/lattice_access.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "core/units.h"
#include "geometry/printed_clearance.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/polyline.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kTiltStep = 15 * kDegree;
constexpr int kAzimuths = 24;
constexpr double kJointMargin = 0.25;  // of the margin, left to what the nozzle may press
constexpr double kRounding = 1e-9;     // [m]
constexpr double kRanking = 50 * kMicrometre,
                 kStated = 2 * kMicrometre;  // of distances, in messages the latter

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<Vec3> tool_axes(double tilt_max) {
  std::vector<Vec3> axes = {Vec3::UnitZ()};
  const auto add_ring = [&](double tilt, double first) {
    for (int k = 0; k < kAzimuths && tilt <= tilt_max + 1e-9; ++k) {
      const double azimuth = 2 * std::numbers::pi * (k + first) / kAzimuths;
      axes.emplace_back(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                        std::cos(tilt));
    }
  };
  for (double tilt = kTiltStep; tilt <= tilt_max + 1e-9; tilt += kTiltStep) add_ring(tilt, 0);
  // Those in between, where no rounder one is clear.
  for (double tilt = kTiltStep / 2; tilt <= tilt_max + 1e-9; tilt += kTiltStep) add_ring(tilt, 0.5);
  return axes;
}

StrutAccess::StrutAccess(const Lattice& lattice, const SequenceLimits& limits)
    : lattice_(lattice),
      limits_(limits),
      tool_(limits.tool),
      joint_tool_(limits.tool, limits.joint_press),
      lifted_(tool_.lifted()),
      lifted_joint_(joint_tool_.lifted()),
      escape_(tool_, limits.margin, limits.lift),
      axes_(tool_axes(limits.tilt_max)),
      touching_(lattice.nodes.size()),
      cases_(2 * lattice.struts.size()),
      from_top_(lattice.struts.size()) {
  for (int s = 0; s < static_cast<int>(lattice.struts.size()); ++s) {
    for (const int node : lattice.struts[at(s)]) touching_[at(node)].push_back(s);
    bodies_.push_back(as_printed(s));
  }
  std::iota(from_top_.begin(), from_top_.end(), 0);
  const auto top = [&](int s) {
    const auto& [a, b] = lattice_.struts[at(s)];
    return std::max(lattice_.nodes[at(a)].position.z(), lattice_.nodes[at(b)].position.z());
  };
  std::stable_sort(from_top_.begin(), from_top_.end(), [&](int l, int r) { return top(l) > top(r); });
  if (!from_top_.empty()) highest_ = top(from_top_.front()) + 0.5 * limits.strut_diameter;
}

std::vector<StrutAccess::Case>& StrutAccess::cases(int strut, int from) {
  auto& cases = cases_[2 * at(strut) + (lattice_.struts[at(strut)][0] == from ? 0 : 1)];
  cases.resize(axes_.size());
  return cases;
}

bool StrutAccess::lies(int strut) const {
  const auto& [a, b] = lattice_.struts[at(strut)];
  return lattice_.nodes[at(a)].grounded && lattice_.nodes[at(b)].grounded;
}

// Whether the strut, where it begins or ends on the table, finds a rising one there already.
bool StrutAccess::meets_another(int node, int strut, const std::vector<char>& standing) const {
  if (!lattice_.nodes[at(node)].grounded || lies(strut)) return false;
  return std::any_of(touching_[at(node)].begin(), touching_[at(node)].end(),
                     [&](int other) { return other != strut && standing[at(other)] && !lies(other); });
}

// The strand hangs below the nozzle, its own centre line on the node; on the table the tip is at the gap.
Vec3 StrutAccess::tip_at(int node, const Vec3& axis, bool on_top) const {
  const LatticeNode& n = lattice_.nodes[at(node)];
  if (n.grounded && !on_top)
    return n.position + (limits_.ground_gap - 0.5 * limits_.strut_diameter) * Vec3::UnitZ();
  return n.position + 0.5 * limits_.strut_diameter * axis;
}

// As it is printed: pressed down to the gap where it stands on the table.
StrutBody StrutAccess::as_printed(int strut) const {
  const auto end = [&](int node) -> Vec3 {
    const LatticeNode& n = lattice_.nodes[at(node)];
    if (!n.grounded) return n.position;
    return n.position + (limits_.ground_gap - limits_.strut_diameter) * Vec3::UnitZ();
  };
  const auto& [a, b] = lattice_.struts[at(strut)];
  return {end(a), end(b), 0.5 * limits_.strut_diameter};
}

// The strut itself as it stands when the tool has reached its end, but for what is still under the nozzle.
StrutBody StrutAccess::fresh(const StrutPrint& print) const {
  const Vec3 down = 0.5 * limits_.strut_diameter * print.axis, along = print.tip_to - print.tip_from;
  const double under = geometry::fresh_path(limits_.nozzle_flat, limits_.strut_diameter);
  return {print.tip_from - down, print.tip_to - down - std::min(1.0, under / along.norm()) * along,
          0.5 * limits_.strut_diameter};
}

StrutPrint StrutAccess::print_along(const Removal& removal, const Vec3& axis,
                                    const std::vector<char>& standing) const {
  StrutPrint print;
  print.strut = removal.strut;
  print.from = removal.from;
  print.to = removal.to;
  print.axis = axis;
  print.tip_from = tip_at(removal.from, axis, meets_another(removal.from, removal.strut, standing));
  print.tip_to = tip_at(removal.to, axis, meets_another(removal.to, removal.strut, standing));
  return print;
}

// Whatever else is built.
std::string StrutAccess::ruled_out(const StrutPrint& print) const {
  std::string why = meets_itself(print);
  return why.empty() ? beyond_reach(print) : why;
}

std::string StrutAccess::meets_itself(const StrutPrint& print) const {
  if (std::min(print.tip_from.z(), print.tip_to.z()) + tool_.lowest(print.axis) < -kRounding)
    return "the tool meets the table";
  if (!lifted_joint_.clears(fresh(print), {print.tip_to, print.tip_to, print.axis},
                            kJointMargin * limits_.margin))
    return "the tool meets the strand that it prints";
  return "";
}

std::string StrutAccess::beyond_reach(const StrutPrint& print) const {
  if (!limits_.way) return "";
  return limits_.way({tool_at(print.tip_from, Vec3::UnitZ()), tool_at(print.tip_from, print.axis),
                      tool_at(print.tip_to, print.axis)},
                     false);
}

// Whether the tool, from outside in, along the strut and out again, could come near another at all.
bool StrutAccess::near(const StrutPrint& print, const StrutBody& other) const {
  const Vec3& axis = print.axis;
  const Vec3 along = print.tip_to - print.tip_from, from = other.from - print.tip_from,
             to = other.to - print.tip_from;
  const double lowest_tip = std::min(0.0, axis.dot(along));
  const double highest = std::max(axis.dot(from), axis.dot(to)) + other.radius + limits_.margin - lowest_tip;
  if (highest < 0) return false;
  const auto across = [&](const Vec3& v) -> Vec3 { return v - axis.dot(v) * axis; };
  const double half = 0.5 * (other.to - other.from).norm() + other.radius + limits_.margin;
  const double away = segment_distance(across(0.5 * (from + to)), Vec3::Zero(), across(along));
  return away < half + tool_.radius(highest);
}

// What is to be kept from another strut: the plain margin, but beside a shared node, and from what lies on
// the table like the strut itself, as much as the nozzle may press into it within a layer.
StrutAccess::Pieces StrutAccess::pieces(const StrutPrint& print, int other) const {
  const StrutBody whole = body(other);
  const double press = limits_.joint_press, part = kJointMargin * limits_.margin;
  if (!near(print, whole)) return {};
  if (lies(other) && lies(print.strut)) return {{{{whole, &lifted_joint_, part, press}}}, 1};
  const auto& [a, b] = lattice_.struts[at(other)];
  const Vec3 along = whole.to - whole.from;
  const Vec3 joint = std::min(1.0, limits_.joint / along.norm()) * along;
  StrutBody rest = whole, at_joint = whole;
  if (a == print.from || a == print.to) {
    rest.from = at_joint.to = whole.from + joint;
  } else if (b == print.from || b == print.to) {
    rest.to = at_joint.from = whole.to - joint;
  } else {
    return {{{{whole, &lifted_, limits_.margin, 0}}}, 1};
  }
  return {{{{at_joint, &lifted_joint_, part, press}, {rest, &lifted_, limits_.margin, 0}}}, 2};
}

bool StrutAccess::clears(const StrutPrint& print, int other) const {
  const ToolMotion motion{print.tip_from, print.tip_to, print.axis};
  const Pieces pieces = this->pieces(print, other);
  return std::all_of(pieces.of.begin(), pieces.of.begin() + pieces.count,
                     [&](const Piece& p) { return p.tool->clears(p.body, motion, p.margin); });
}

// By how much it is too near, and how near; nothing lacks below `enough`.
StrutAccess::Obstacle StrutAccess::lacks(const StrutPrint& print, int other, double enough,
                                         double tolerance) const {
  const ToolMotion motion{print.tip_from, print.tip_to, print.axis};
  const Pieces pieces = this->pieces(print, other);
  Obstacle worst{enough, 0, 0, -1, ""};
  for (int i = 0; i < pieces.count; ++i) {
    const Piece& p = pieces.of[static_cast<std::size_t>(i)];
    if (p.tool->clears(p.body, motion, p.margin - worst.lack)) continue;
    const double distance = p.tool->distance(p.body, motion, tolerance);
    if (p.margin - distance > worst.lack)
      worst = {p.margin - distance, distance - p.press, p.margin - p.press, other, ""};
  }
  return worst;
}

// Beyond the plane across the axis that everything built lies below.
void StrutAccess::raise(StrutPrint& print, const std::vector<StrutBody>& built) const {
  double level = -std::numeric_limits<double>::infinity();
  const auto raise = [&](const StrutBody& b) {
    level = std::max({level, print.axis.dot(b.from) + b.radius, print.axis.dot(b.to) + b.radius});
  };
  for (const StrutBody& b : built) raise(b);
  print.out_from = limits_.lift + std::max(0.0, level - print.axis.dot(print.tip_from));
  raise(body(print.strut));
  print.out_to = limits_.lift + std::max(0.0, level - print.axis.dot(print.tip_to));
}

std::string StrutAccess::complete(StrutPrint& print, const std::vector<char>& standing) const {
  std::vector<StrutBody> built;
  for (const int s : from_top_)
    if (standing[at(s)] && s != print.strut) built.push_back(body(s));
  raise(print, built);
  const auto pose = [&](const Vec3& tip, double out) { return tool_at(tip, print.axis, out); };
  std::string why = "travel cannot turn the tool upright clear of what is built";
  const auto follows = [&](const std::vector<Pose>& way) {
    if (!limits_.way) return true;
    const std::string said = limits_.way(way, true);
    if (!said.empty()) why = "on travel " + said;
    return said.empty();
  };
  const auto arrival = escape_.find(pose(print.tip_from, print.out_from).translation(), print.axis, built,
                                    [&](std::vector<Pose> way) {
                                      std::reverse(way.begin(), way.end());
                                      way.push_back(pose(print.tip_from, 0));
                                      return follows(way);
                                    });
  if (!arrival) return why;
  built.push_back(body(print.strut));
  std::vector<Pose> whole(arrival->rbegin(), arrival->rend());
  whole.insert(whole.end(), {pose(print.tip_from, 0), pose(print.tip_to, 0)});
  const auto departure = escape_.find(pose(print.tip_to, print.out_to).translation(), print.axis, built,
                                      [&](const std::vector<Pose>& way) {
                                        std::vector<Pose> all = whole;
                                        all.insert(all.end(), way.begin(), way.end());
                                        return follows(all);
                                      });
  if (!departure) return why;
  print.arrival.assign(arrival->rbegin(), arrival->rend());
  print.departure = *departure;
  return "";
}

void StrutAccess::complete_anyhow(StrutPrint& print) const {
  std::vector<StrutBody> all;
  for (const int s : from_top_) all.push_back(body(s));
  raise(print, all);
  const auto up = [&](const Vec3& tip, double out) -> std::vector<Pose> {
    const Pose outside = tool_at(tip, print.axis, out);
    Vec3 high = outside.translation();
    high.z() = std::max(high.z(), highest_ + limits_.lift - tool_.lowest(print.axis));
    return {outside, tool_at(high, print.axis), tool_at(high, Vec3::UnitZ())};
  };
  print.departure = up(print.tip_to, print.out_to);
  print.arrival = up(print.tip_from, print.out_from);
  std::reverse(print.arrival.begin(), print.arrival.end());
}

bool StrutAccess::find(const Removal& removal, const std::vector<char>& standing, StrutPrint& print) {
  std::vector<Case>& cases = this->cases(removal.strut, removal.from);
  const bool on_top = meets_another(removal.from, removal.strut, standing) ||
                      meets_another(removal.to, removal.strut, standing);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Case& c = cases[i];
    if (c.on_top != on_top) c = {.on_top = on_top};
    if (c.fit == Fit::never || (c.obstacle >= 0 && standing[at(c.obstacle)])) continue;
    print = print_along(removal, axes_[i], standing);
    if (c.fit == Fit::unknown && !meets_itself(print).empty()) c.fit = Fit::never;
    if (c.fit == Fit::never) continue;
    const auto begin = from_top_.begin() + (c.round == round_ ? c.clear_to : 0);
    const auto obstacle = std::find_if(begin, from_top_.end(), [&](int other) {
      return standing[at(other)] && other != removal.strut && !clears(print, other);
    });
    c.obstacle = obstacle == from_top_.end() ? -1 : *obstacle;
    c.clear_to = static_cast<int>(obstacle - from_top_.begin());
    c.round = round_;
    if (c.obstacle >= 0) continue;
    if (c.fit == Fit::unknown) c.fit = beyond_reach(print).empty() ? Fit::possible : Fit::never;
    if (c.fit == Fit::never) continue;
    if (complete(print, standing).empty()) return true;
    // Travel goes above the highest strut that stands: until that is gone there is little to hope for.
    const auto highest =
        std::find_if(from_top_.begin(), from_top_.end(), [&](int other) { return standing[at(other)] != 0; });
    if (highest != from_top_.end()) c.obstacle = *highest;
  }
  return false;
}

std::string StrutAccess::blocked(const Removal& removal, const Vec3& axis, const std::vector<char>& standing,
                                 StrutPrint& print) const {
  print = print_along(removal, axis, standing);
  if (std::string why = meets_itself(print); !why.empty()) return why;
  std::vector<StrutBody> built;
  for (const int other : from_top_) {
    if (!standing[at(other)] || other == removal.strut) continue;
    if (!clears(print, other)) {
      const Obstacle near = lacks(print, other, 0, kStated);
      const auto& [a, b] = lattice_.struts[at(other)];
      return fmt::format("the tool comes to {:.3f} mm from the strut from {} to {}, the limit is {:.3f} mm",
                         to_mm(near.distance), in_mm(lattice_.nodes[at(a)].position),
                         in_mm(lattice_.nodes[at(b)].position), to_mm(near.limit));
    }
    built.push_back(body(other));
  }
  raise(print, built);
  return "";
}

bool StrutAccess::never(int strut, std::string& why) const {
  const std::vector<char> none(lattice_.struts.size());
  const auto& [a, b] = lattice_.struts[at(strut)];
  why.clear();
  for (const Removal& removal : {Removal{strut, a, b}, Removal{strut, b, a}})
    for (const Vec3& axis : axes_) {
      const std::string said = ruled_out(print_along(removal, axis, none));
      if (said.empty()) return false;
      if (why.empty()) why = said;
    }
  return true;
}

StrutAccess::Obstacle StrutAccess::clearest(const Removal& removal, const std::vector<char>& standing,
                                            StrutPrint& best) const {
  Obstacle answer;
  for (const Vec3& axis : axes_) {
    StrutPrint print = print_along(removal, axis, standing);
    if (std::string why = ruled_out(print); !why.empty()) {
      if (answer.why.empty()) answer.why = std::move(why);
      continue;
    }
    Obstacle nearest{0, 0, 0, -1, ""};
    for (const int other : from_top_) {
      if (nearest.lack >= answer.lack) break;
      if (!standing[at(other)] || other == removal.strut || clears(print, other)) continue;
      if (Obstacle found = lacks(print, other, nearest.lack, kRanking); found.strut >= 0)
        nearest = std::move(found);
    }
    if (nearest.lack >= answer.lack) continue;
    if (nearest.strut < 0) nearest.why = complete(print, standing);
    answer = std::move(nearest);
    best = std::move(print);
  }
  if (answer.strut >= 0)
    if (Obstacle stated = lacks(best, answer.strut, 0, kStated); stated.strut >= 0) return stated;
  return answer;
}

}  // namespace understudy::toolpath
