#include "kinematics/chain/delta.h"

#include <algorithm>
#include <cmath>

#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/chain_mechanism.h"
#include "kinematics/chain/rods.h"
#include "kinematics/chain/task_jacobian.h"

namespace understudy::kinematics {
namespace {

constexpr double kUpright = 1e-9;  // [rad], to which a tool's axis that cannot tilt has to agree

class Delta final : public ChainMechanism {
 public:
  explicit Delta(const ChainDescription& description)
      : ChainMechanism(description, false), lean_max_(delta_geometry(description.parameters).lean_max) {}

  SolveStatus inverse(const Pose& X_ST, std::span<const double> previous,
                      std::span<double> axes) const override {
    if (axes.size() < kRods || !is_pose(X_ST) || !usable(previous)) return SolveStatus::bad_input;
    if (!upright(X_ST)) return SolveStatus::unreachable;
    return slides_of_rods(chain(), meeting_point(X_ST), axes);
  }

  SolveStatus forward(std::span<const double> axes, const Pose& seed, Pose& X_ST) const override {
    Pose X;
    const SolveStatus status = ChainMechanism::forward(axes, seed, X);
    if (status != SolveStatus::ok) return status;
    Vec3 p_O;
    if (rods_meet(chain(), axes, p_O) != SolveStatus::ok) return SolveStatus::unreachable;
    X_ST = X;
    return SolveStatus::ok;
  }

  // Of the tip alone: tilts are for no axis to make.
  double condition_number(const Pose& X_ST, std::span<const double> axes) const override {
    if (axes.size() < kRods || !is_pose(X_ST) || !std::isfinite(axes[0] + axes[1] + axes[2]))
      return kSingularCondition;
    ChainJacobian J;
    kinematics::forward(chain(), axes, J);
    return kinematics::condition_number(TaskJacobian(J.topRows<3>()), kSingularCondition);
  }

  void check(const Pose& X_ST, std::span<const double> axes,
             std::vector<LimitViolation>& violations) const override {
    const std::size_t before = violations.size();
    if (axes.size() < kRods && is_pose(X_ST)) {
      for (int i = 0; i < kRods; ++i) {
        const double span = rod_span(chain(), meeting_point(X_ST), i), length = chain().rods[std::size_t(i)];
        if (span > length) violations.push_back({LimitKind::unreachable, rod_name(i), span, length, "m"});
      }
      if (violations.size() > before) return;
    }
    ChainMechanism::check(X_ST, axes, violations);
    if (axes.size() < kRods) return;
    Vec3 p_O;
    if (rods_meet(chain(), axes, p_O) != SolveStatus::ok) return;
    const Mat3 rods = rod_vectors(chain(), axes, p_O);
    for (int i = 0; i < kRods; ++i)
      if (const double lean = rod_lean(chain(), rods, i); lean > lean_max_)
        violations.push_back({LimitKind::joint_angle, rod_name(i), lean, lean_max_, "rad"});
  }

 private:
  std::string rod_name(int rod) const { return "rod " + chain().axes[std::size_t(rod)].name; }

  bool upright(const Pose& X_ST) const {
    const Vec3 axis = chain().X_OS_zero.linear() * tool_axis(X_ST);
    return axis.cross(tool_axis(chain().X_OT_zero)).norm() <= kUpright &&
           axis.dot(tool_axis(chain().X_OT_zero)) > 0;
  }

  Vec3 meeting_point(const Pose& X_ST) const {
    return chain().X_OS_zero * X_ST.translation() - chain().X_OT_zero.translation();
  }

  double lean_max_;
};

}  // namespace

DeltaGeometry delta_geometry(std::span<const double> parameters) {
  DeltaGeometry geometry;
  for (std::size_t i = 0; i < geometry.towers.size(); ++i)
    geometry.towers[i] = {parameters[4 * i], parameters[4 * i + 1], parameters[4 * i + 2],
                          parameters[4 * i + 3]};
  geometry.joint_height = parameters[12];
  geometry.lean_max = parameters[13];
  return geometry;
}

Chain delta_chain(const DeltaGeometry& geometry) {
  Chain chain;
  for (std::size_t i = 0; i < geometry.towers.size(); ++i) {
    const DeltaTower& tower = geometry.towers[i];
    ChainAxis axis = sliding_axis(std::string(1, "abc"[i]), Vec3::UnitZ(), -1);
    axis.point = {tower.radius * std::cos(tower.angle), tower.radius * std::sin(tower.angle), tower.zero};
    chain.axes.push_back(axis);
    chain.rods.push_back(tower.rod);
  }
  chain.X_OT_zero.translation() = Vec3(0, 0, -geometry.joint_height);
  return chain;
}

ChainKind delta_kind() {
  ChainKind kind;
  kind.name = "delta";
  for (const char* tower : {"a", "b", "c"}) {
    const std::string of = std::string("_") + tower;
    kind.parameters.push_back({"radius" + of + "_mm", 1, 10'000,
                               "from the middle to the tower, less the offsets of the rod's joints"});
    kind.parameters.push_back({"angle" + of + "_deg", -360, 360, "of the tower about z, from x"});
    kind.parameters.push_back({"rod" + of + "_mm", 1, 10'000, "between the joints of its rods"});
    kind.parameters.push_back({"zero" + of + "_mm", -50, 50, "correction of its end stop"});
  }
  kind.parameters.push_back({"joint_height_mm", -1'000, 1'000, "of the joints on the tool, above the tip"});
  kind.parameters.push_back({"rod_lean_max_deg", 1, 89.9, "largest angle between a rod and its tower"});
  kind.chain = [](std::span<const double> parameters) { return delta_chain(delta_geometry(parameters)); };
  kind.make = [](const ChainDescription& description) -> std::unique_ptr<Mechanism> {
    return std::make_unique<Delta>(description);
  };
  return kind;
}

}  // namespace understudy::kinematics
