#include "cli/plan/machine_reach.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "control/motion/path_kinematics.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::cli {
namespace {

using kinematics::SolveStatus;

constexpr const char* kAsking = "asking the machine";
constexpr double kTiltShare = 1e-3;  // to which a possible tilt is found

struct Spacing {
  double path, turn;  // [m], [rad]
};
constexpr Spacing kFine{2e-3, 2 * kDegree}, kCoarse{8e-3, 6 * kDegree};

/// Where and why the machine cannot follow a way.
struct Obstacle {
  Pose X_WT;
  std::string why;
};

enum class Singular { refused, allowed };

class MachineReach {
 public:
  MachineReach(const machine::MachineDescription& machine, Singular singular)
      : mechanism_(machine.make_mechanism()),
        X_BW_(machine.X_WB.inverse()),
        axes_(static_cast<std::size_t>(mechanism_->axis_count())),
        singular_(singular) {}

  /// Puts `at` on the axes for the pose nearest to them; on the branch of the machine's home without `near`.
  std::string stand(const Pose& X_WT, std::span<const double> near, kinematics::AxisVector& at) const {
    const std::span<double> axes = std::span(at).first(axes_);
    const Pose X_BT = X_BW_ * X_WT;
    const SolveStatus status = mechanism_->inverse(X_BT, near.first(std::min(near.size(), axes_)), axes);
    std::vector<kinematics::LimitViolation> violations;
    mechanism_->check(X_BT,
                      status == SolveStatus::ok ? std::span<const double>(axes) : std::span<const double>(),
                      violations);
    if (singular_ == Singular::allowed)
      std::erase_if(violations, [](const auto& v) { return v.kind == kinematics::LimitKind::singularity; });
    if (!violations.empty()) return to_string(violations.front());
    return status == SolveStatus::ok ? "" : std::string("the pose is ") + to_string(status);
  }

  /// Leads the axes, which stand at `from`, to `to`.
  std::optional<Obstacle> lead(const Pose& from, const Pose& to, const Spacing& spacing,
                               kinematics::AxisVector& at) const {
    const double path = (to.translation() - from.translation()).norm(),
                 turn = angle_between(from.linear(), to.linear());
    const int parts =
        std::max(1, static_cast<int>(std::ceil(std::max(path / spacing.path, turn / spacing.turn))));
    for (int k = 1; k <= parts; ++k) {
      const kinematics::AxisVector before = at;
      const Pose X_WT = interpolate(from, to, static_cast<double>(k) / parts);
      std::string why = stand(X_WT, before, at);
      if (why.empty()) why = leap(before, at);
      if (!why.empty()) return Obstacle{X_WT, why};
    }
    return std::nullopt;
  }

  std::string walk(const std::vector<Pose>& way, bool fine) const {
    kinematics::AxisVector at{};
    if (std::string why = stand(way.front(), {}, at); !why.empty()) return why;
    for (std::size_t i = 1; i < way.size(); ++i) {
      if (const auto obstacle = lead(way[i - 1], way[i], fine ? kFine : kCoarse, at)) return obstacle->why;
    }
    return "";
  }

 private:
  // Machines that leave the spin free turn an axis at rest where they would have to leap.
  std::string leap(const kinematics::AxisVector& before, const kinematics::AxisVector& after) const {
    if (!mechanism_->follows_spin()) return "";
    for (std::size_t i = 0; i < axes_; ++i) {
      const int axis = static_cast<int>(i);
      const double turn = std::abs(after[i] - before[i]);
      if (mechanism_->axis_is_angle(axis) && turn > control::kMaxAxisJump)
        return fmt::format("axis {} would leap by {:.0f} deg: the way passes too near a singular pose",
                           mechanism_->axis_name(axis), to_deg(turn));
    }
    return "";
  }

  std::shared_ptr<const kinematics::Mechanism> mechanism_;
  Pose X_BW_;
  std::size_t axes_;
  Singular singular_;
};

double tilt_of(const Pose& X_WT) { return std::acos(std::clamp(X_WT.linear().col(2).z(), -1.0, 1.0)); }

/// What the machine could do at this place, leaning the same way.
std::string possible_tilt(const Pose& X_WT, const toolpath::WayCheck& reach) {
  const auto leaning = [&](double share) {
    const Vec3 axis = X_WT.linear().col(2), across = Vec3::UnitZ().cross(axis);
    const double tilt = share * tilt_of(X_WT);
    const Mat3 R = across.norm() > 0 ? Mat3(Eigen::AngleAxisd(tilt, across.normalized())) : Mat3::Identity();
    return make_pose(R, Vec3(X_WT.translation()));
  };
  const auto can = [&](double share) { return reach({leaning(share)}, false).empty(); };
  if (!can(0)) return "it does not get there upright either";
  double good = 0, bad = 1;
  if (can(1)) return "it could stand there, but is not led there without a leap";
  while (bad - good > kTiltShare) (can((good + bad) / 2) ? good : bad) = (good + bad) / 2;
  return fmt::format("it could lean by {:.1f} deg there", to_deg(good * tilt_of(X_WT)));
}

}  // namespace

toolpath::WayCheck machine_reach(const machine::MachineDescription& machine) {
  return [reach = MachineReach(machine, Singular::refused)](const std::vector<Pose>& way, bool fine) {
    return reach.walk(way, fine);
  };
}

void check_reach(const toolpath::Program& program, const machine::MachineDescription& machine,
                 const Progress& progress) {
  const toolpath::WayCheck reach = machine_reach(machine);
  std::vector<Pose> way;
  std::size_t done = 0;
  for (const toolpath::Step& step : program.steps) {
    tell(progress, ++done, program.steps.size(), kAsking);
    if (!toolpath::moves(step)) continue;
    way.push_back(step.X_WT);
    if (way.size() < 2) continue;
    if (const std::string why = reach(way, false); !why.empty()) {
      const Vec3 p = step.X_WT.translation();
      throw InputError(
          fmt::format("at ({:.2f}, {:.2f}, {:.2f}) mm the tool leans by {:.1f} deg, which {} cannot follow: "
                      "{}; {}; place "
                      "the part otherwise, or --ignore-reach",
                      to_mm(p.x()), to_mm(p.y()), to_mm(p.z()), to_deg(tilt_of(step.X_WT)), machine.name, why,
                      possible_tilt(step.X_WT, reach)));
    }
    way.erase(way.begin());
  }
}

void check_reach_from_home(const toolpath::Program& program, const machine::MachineDescription& machine,
                           const Progress& progress) {
  const MachineReach reach(machine, Singular::allowed);
  Pose X_WT = machine.X_WB * machine.X_BT_home;
  kinematics::AxisVector at{};
  if (const std::string why = reach.stand(X_WT, {}, at); !why.empty())
    throw InputError(fmt::format("machine {} cannot stand at its home: {}", machine.name, why));
  std::size_t done = 0;
  for (const toolpath::Step& step : program.steps) {
    tell(progress, ++done, program.steps.size(), kAsking);
    if (!toolpath::moves(step)) continue;
    if (const auto obstacle = reach.lead(X_WT, step.X_WT, kFine, at)) {
      const Vec3 p = obstacle->X_WT.translation();
      throw InputError(
          fmt::format("at ({:.2f}, {:.2f}, {:.2f}) mm the part is out of reach of {}: {}; take a smaller "
                      "part, or --ignore-reach",
                      to_mm(p.x()), to_mm(p.y()), to_mm(p.z()), machine.name, obstacle->why));
    }
    X_WT = step.X_WT;
  }
}

}  // namespace understudy::cli
