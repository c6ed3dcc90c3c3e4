// Where a tool can go: a grid of tip positions at given orientations against everything that the mechanism
// checks. A point is reachable when it is so, without breaking a limit, in every orientation asked for.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/mechanism.h"

namespace understudy::kinematics {

/// Cells of `step`, as many as fit, centred in the box; a point is the middle of its cell. An axis along
/// which no cell fits has one, in the middle of the box.
struct WorkspaceGrid {
  Vec3 lower{0, 0, 0}, upper{0, 0, 0};  ///< [m], corners of the box, in W
  double step = 0;                      ///< [m], above 0

  std::array<int, 3> cells() const;
  std::int64_t size() const;
  Vec3 point(int x, int y, int z) const;
};

/// The width of the range that a limit ends: what an excess is compared with.
struct LimitSpan {
  std::string family;  ///< as limit_family() tells it
  double width = 0;    ///< SI
};

struct WorkspaceRequest {
  WorkspaceGrid grid;
  Pose X_BW = Pose::Identity();
  std::vector<Mat3> orientations;        ///< R_WT, at least one
  std::vector<LimitSpan> spans;          ///< limits without one are compared with their own value
  int threads = 1;                       ///< the result does not depend on it
  std::function<void(double)> progress;  ///< share done in [0, 1]; called by one thread at a time
};

/// One end of a range and what it costs.
struct WorkspaceLimit {
  LimitKind kind = LimitKind::unreachable;
  std::string part;         ///< of LimitViolation; of a family: without its number
  bool above = false;       ///< the value is too large, not too small
  double limit = 0;         ///< SI
  std::string unit;         ///< SI unit of `limit`; empty where there is none
  int family = 0;           ///< index into Workspace::families
  std::int64_t broken = 0;  ///< points that break it
  std::int64_t binds = 0;   ///< points where it binds first
  std::int64_t alone = 0;   ///< points that break nothing else: they would open up without it
};

/// What the reachable points ask of an axis.
struct AxisUse {
  double lowest = 0, highest = 0;  ///< [m] or [rad]
};

/// The binding limit of a point is the one with the largest excess |value - limit|: as a share of its span,
/// or of the larger of value and limit where no span is known. No solution at all comes before every limit;
/// of equal ones, the first that the mechanism names.
struct Workspace {
  WorkspaceGrid grid;
  // One a point, x fastest, then y.
  std::vector<std::uint16_t> binding;  ///< 0: reachable; else 1 + index into `limits`
  std::vector<float> margin;     ///< smallest of all axes: 1 mid-range, 0 at an end; 0 where unreachable
  std::vector<float> condition;  ///< worst of the orientations; 0 where unreachable

  std::int64_t reachable = 0;
  std::vector<WorkspaceLimit> limits;    ///< most binding first
  std::vector<WorkspaceLimit> families;  ///< the same limit of all equal parts; most binding first
  std::vector<AxisUse> axes;             ///< one an axis; empty where nothing is reachable

  std::size_t index(int x, int y, int z) const;
  bool reaches(int x, int y, int z) const { return binding[index(x, y, z)] == 0; }
  double fraction() const { return static_cast<double>(reachable) / static_cast<double>(binding.size()); }
};

/// "ball joint" of "ball joint 3", "struts" of "struts 1 and 6": what equal parts have in common.
std::string limit_family(const std::string& part);

/// Throws Interrupted when the user stops it; std::invalid_argument for a request without points,
/// orientations or threads.
Workspace evaluate_workspace(const Mechanism& mechanism, const WorkspaceRequest& request);

/// Points from `first` to `last`, both included.
struct PointBox {
  std::array<int, 3> first{}, last{};
};
/// The largest cube whose points are all reachable; of equal ones the nearest to the middle of the grid.
std::optional<PointBox> largest_cube(const Workspace& workspace);
/// The box along the axes with the most points, all reachable.
std::optional<PointBox> largest_box(const Workspace& workspace);

/// Values at the shares 0, 0.05, 0.5, 0.95 and 1 of the reachable points in order; empty without any.
std::vector<double> reachable_quantiles(const Workspace& workspace, const std::vector<float>& values);
constexpr std::array<double, 5> kWorkspaceQuantiles{0, 0.05, 0.5, 0.95, 1};

}  // namespace understudy::kinematics
