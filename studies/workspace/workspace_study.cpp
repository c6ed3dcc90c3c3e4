#include "studies/workspace/workspace_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "core/yaml/file_unit.h"

namespace understudy::studies {
namespace {

constexpr int kAzimuths = 12;
constexpr int kCellsByDefault = 40;  // along the longest side: a second or a few

Vec3 towards(double azimuth) { return {std::cos(azimuth), std::sin(azimuth), 0}; }

/// Rotation that leans the z axis towards `azimuth` without a turn about itself.
Mat3 lean(double tilt, double azimuth) { return exp_rotation(tilt * Vec3::UnitZ().cross(towards(azimuth))); }

struct Lean {
  double tilt = 0, azimuth = 0;  ///< [rad]
};

Lean lean_of(const Vec3& axis) {
  constexpr double kUpright = 1e-9;  // below, the azimuth is rounding
  const double level = std::hypot(axis.x(), axis.y());
  return {std::atan2(level, axis.z()), level < kUpright ? 0.0 : std::atan2(axis.y(), axis.x())};
}

std::vector<kinematics::LimitSpan> limit_spans(const machine::MachineDescription& machine) {
  using Spans = std::vector<kinematics::LimitSpan>;
  return machine.visit(
      [](const machine::HexapodModel& hexapod) -> Spans {
        const auto& limits = hexapod.limits;
        return {{"strut", limits.strut_max - limits.strut_min},
                {"base joint", limits.base_alpha_max - limits.base_alpha_min},
                {"base joint (lateral)", 2 * limits.base_beta_max},
                {"ball joint", limits.ball_max - limits.ball_min}};
      },
      [](const machine::ChainModel& chain) {
        Spans spans;
        for (const auto& axis : chain.kinematics.chain.axes)
          spans.push_back({"axis " + axis.name, axis.upper - axis.lower});
        return spans;
      });
}

kinematics::WorkspaceGrid make_grid(const machine::MachineDescription& machine,
                                    const WorkspaceOptions& options) {
  const auto box = options.box.value_or(default_workspace_box(machine));
  kinematics::WorkspaceGrid grid;
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const double lower = box[2 * i], upper = box[2 * i + 1];
    constexpr double kFar = 100;  // [m], more than a slip of the unit
    if (!(std::abs(lower) <= kFar && std::abs(upper) <= kFar))
      throw InputError(fmt::format("--box: {} {:g}..{:g} mm is not within +-{:g} mm", "xyz"[i], to_mm(lower),
                                   to_mm(upper), to_mm(kFar)));
    if (lower > upper)
      throw InputError(fmt::format("--box: {} ends at {:g} mm, below its beginning at {:g} mm", "xyz"[i],
                                   to_mm(upper), to_mm(lower)));
    grid.lower[i] = lower;
    grid.upper[i] = upper;
    longest = std::max(longest, upper - lower);
  }
  grid.step = options.step.value_or(longest > 0 ? longest / kCellsByDefault : kMillimetre);
  if (!(grid.step > 0) || !std::isfinite(grid.step))
    throw InputError(fmt::format("--step {:g} mm must be above 0", to_mm(grid.step)));
  double points = 1;
  for (int i = 0; i < 3; ++i) points *= std::max(1.0, (grid.upper[i] - grid.lower[i]) / grid.step);
  if (points > kWorkspacePointsMax)
    throw InputError(fmt::format("--step {:g} mm makes {:.3g} points, more than {:.3g}", to_mm(grid.step),
                                 points, kWorkspacePointsMax));
  return grid;
}

/// Told to the nanometre: rounding of the machine's frame is no figure for people.
std::array<double, 6> box_around(const Vec3& middle, const Vec3& half) {
  std::array<double, 6> box{};
  for (int i = 0; i < 3; ++i) {
    box[2 * i] = std::round(1e9 * (middle[i] - half[i])) / 1e9 + 0.0;
    box[2 * i + 1] = std::round(1e9 * (middle[i] + half[i])) / 1e9 + 0.0;
  }
  return box;
}

/// How far the slide that lifts tool or work reaches, if there is one.
std::optional<double> height_of(const kinematics::Chain& chain) {
  std::optional<double> height;
  for (const auto& axis : chain.axes)
    if (!axis.angle && std::abs(axis.direction.z()) > 0.99 && axis.upper > 0 && std::isfinite(axis.upper))
      height = std::max(height.value_or(0), axis.upper);
  return height;
}

double degrees_within(const char* option, double value, double low, double high) {
  if (!(value >= low - 1e-12 && value <= high + 1e-12))
    throw InputError(fmt::format("{} {:g} deg is outside {:g}..{:g} deg", option, to_deg(value), to_deg(low),
                                 to_deg(high)));
  return value;
}

}  // namespace

std::array<double, 6> default_workspace_box(const machine::MachineDescription& machine) {
  return machine.visit(
      [&](const machine::HexapodModel&) {
        const Vec3 home = (machine.X_WB * machine.X_BT_home).translation();
        return box_around(home, Vec3::Constant(0.050));
      },
      [&](const machine::ChainModel& chain) {
        const Vec3 size = std::get<geometry::Box>(machine.table.form).size;
        const double height = height_of(chain.kinematics.chain).value_or(std::min(size.x(), size.y()));
        const Vec3 middle = machine.table.X_FS.translation();
        return box_around({middle.x(), middle.y(), height / 2}, {size.x() / 2, size.y() / 2, height / 2});
      });
}

WorkspaceStudy plan_workspace(const machine::MachineDescription& machine, const WorkspaceOptions& options) {
  constexpr double kPi = std::numbers::pi;
  WorkspaceStudy study;
  study.machine = machine;
  study.command = options.command;
  const Pose X_WT_home = machine.X_WB * machine.X_BT_home;
  const Lean home = lean_of(tool_axis(X_WT_home));
  study.tilt = degrees_within("--tilt", options.tilt.value_or(home.tilt), 0, kPi);
  const double azimuth =
      degrees_within("--azimuth", options.azimuth.value_or(home.azimuth), -2 * kPi, 2 * kPi);
  for (int i = 0; i < (options.all_azimuths ? kAzimuths : 1); ++i)
    study.azimuths.push_back(azimuth + i * 2 * kPi / kAzimuths);

  kinematics::WorkspaceRequest& request = study.request;
  request.grid = make_grid(machine, options);
  request.X_BW = machine.X_WB.inverse();
  const Mat3 R_WT_upright = lean(-home.tilt, home.azimuth) * X_WT_home.linear();
  for (const double a : study.azimuths) request.orientations.push_back(lean(study.tilt, a) * R_WT_upright);
  request.spans = limit_spans(machine);
  request.threads = options.threads;
  return study;
}

void evaluate(WorkspaceStudy& study, std::function<void(double)> progress) {
  study.request.progress = std::move(progress);
  study.workspace = kinematics::evaluate_workspace(*study.machine.make_mechanism(), study.request);
  study.request.progress = nullptr;
}

std::string limit_text(const kinematics::WorkspaceLimit& limit) {
  if (limit.unit.empty()) return limit.part + " out of reach";
  const FileUnit unit = file_unit(limit.unit);
  const bool number = limit.unit == "1";
  const std::string value =
      fmt::format("{:.4g}{}", unit.factor * limit.limit, number ? "" : std::string(" ") + unit.name);
  using kinematics::LimitKind;
  switch (limit.kind) {
    case LimitKind::strut_length:
      return limit.part + (limit.above ? " longer than " : " shorter than ") + value;
    case LimitKind::screw_distance:
      return limit.part + " nearer than " + value;
    case LimitKind::singularity:
      return limit.part + (number ? " condition above " + value : " within " + value + " of singular");
    case LimitKind::unreachable:
      return limit.part + (limit.above ? " spans above " : " spans below ") + value;
    default:
      return limit.part + (limit.above ? " above " : " below ") + value;
  }
}

std::string orientation_text(const WorkspaceStudy& study) {
  const double tilt = to_deg(study.tilt);
  if (tilt < 1e-6) return "tool upright";
  if (study.azimuths.size() > 1) return fmt::format("tool tilted {:.4g} deg towards every azimuth", tilt);
  return fmt::format("tool tilted {:.4g} deg towards azimuth {:.4g} deg", tilt, to_deg(study.azimuths[0]));
}

}  // namespace understudy::studies
