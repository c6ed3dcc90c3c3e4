#include "kinematics/chain/five_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/chain_mechanism.h"
#include "kinematics/rigid_pose.h"

namespace understudy::kinematics {
namespace {

// Sine of the tool's tilt below which C is free (docs/reference.md#five-axis-printer).
constexpr double kUpright = 1e-12;
constexpr double kTurn = 2 * std::numbers::pi;

enum Axis : std::size_t { kX, kY, kZ, kB, kC };

Mat3 turn_y(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix(); }
Mat3 turn_z(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(); }

Vec3 on_b_axis(const FiveAxisGeometry& g) { return {g.b_axis_x, 0, g.b_axis_z}; }
Vec3 on_c_axis(const FiveAxisGeometry& g) { return {g.c_axis_x, g.c_axis_y, 0}; }

/// The turn of `angle` nearest to `near`; where that lies outside the range, one that lies inside if there
/// is.
double turn_within(double angle, double near, const ChainAxis& axis) {
  const double nearest = nearest_turn(angle, near);
  if (nearest > axis.upper) {
    const double lower = nearest - kTurn * std::ceil((nearest - axis.upper) / kTurn);
    return lower >= axis.lower ? lower : nearest;
  }
  if (nearest < axis.lower) {
    const double higher = nearest + kTurn * std::ceil((axis.lower - nearest) / kTurn);
    return higher <= axis.upper ? higher : nearest;
  }
  return nearest;
}

FiveAxisGeometry geometry_of(std::span<const double> p) { return {p[0], p[1], p[2], p[3]}; }

/// What the axes do at a tip's place and turns of the table while the tip moves over the part and the table
/// turns at these rates.
FiveAxes rates_at_tip(const FiveAxisGeometry& geometry, const RotaryTarget& at, const RotaryTarget& rate) {
  const Vec3 b_axis = on_b_axis(geometry), c_axis = on_c_axis(geometry);
  const Mat3 R_b = turn_y(-at.b), R_c = turn_z(-at.c);
  const Vec3 from_c = R_c * (at.p_BT - c_axis);
  const Vec3 turned_rate = R_c * rate.p_BT - rate.c * Vec3::UnitZ().cross(from_c);
  const Vec3 from_b = R_b * (c_axis + from_c - b_axis);
  const Vec3 slides = R_b * turned_rate - rate.b * Vec3::UnitY().cross(from_b);
  return {slides.x(), slides.y(), slides.z(), rate.b, rate.c};
}

/// Whether the words are X Y Z and the turns b and c, each as the axis counts.
bool words_are_axes(const ChainDescription& d) {
  const auto plain = [](const AxisWord& word, std::size_t axis) {
    return word.axis == axis && word.sign == 1 && word.zero == 0;
  };
  return d.turn_words.size() == 2 && d.slide_words.size() == 3 && plain(d.turn_words[0], kB) &&
         plain(d.turn_words[1], kC) && plain(d.slide_words[0], kX) && plain(d.slide_words[1], kY) &&
         plain(d.slide_words[2], kZ);
}

class FiveAxis final : public ChainMechanism {
 public:
  explicit FiveAxis(const ChainDescription& description)
      : ChainMechanism(description, false),
        geometry_(geometry_of(description.parameters)),
        plain_words_(words_are_axes(description)) {}

  // The branch that breaks fewer ranges; of equal ones the nearer to `previous`.
  SolveStatus inverse(const Pose& X_ST, std::span<const double> previous,
                      std::span<double> axes) const override {
    if (axes.size() < kFiveAxes) return SolveStatus::bad_input;
    FiveAxes from;
    std::copy_n(near(previous).begin(), kFiveAxes, from.begin());
    for (const double v : from)
      if (!std::isfinite(v)) return SolveStatus::bad_input;
    FiveAxisBranches branches;
    const SolveStatus status = five_axis_branches(geometry_, X_ST, from[kC], branches);
    if (status != SolveStatus::ok) return status;
    Choice best;
    for (std::size_t n = 0; n < branches.axes.size(); ++n) {
      const Choice choice = unwound(branches.axes[n], from);
      const bool better =
          choice.broken != best.broken ? choice.broken < best.broken : choice.distance < best.distance;
      if (n == 0 || better) best = choice;
    }
    std::copy(best.axes.begin(), best.axes.end(), axes.begin());
    return SolveStatus::ok;
  }

  // Words that are the axes themselves have closed forms.
  SolveStatus pose_at_turns(const RotaryTarget& at, Pose& X_ST) const override {
    if (!plain_words_ || !finite(at)) return ChainMechanism::pose_at_turns(at, X_ST);
    X_ST = five_axis_tip_pose(at.p_BT, at.b, at.c);
    return SolveStatus::ok;
  }

  SolveStatus pose_at_slides(const RotaryTarget& at, Pose& X_ST) const override {
    if (!plain_words_ || !finite(at)) return ChainMechanism::pose_at_slides(at, X_ST);
    X_ST = five_axis_pose(geometry_, {at.p_BT.x(), at.p_BT.y(), at.p_BT.z(), at.b, at.c});
    return SolveStatus::ok;
  }

  SolveStatus slides_at_turns(const RotaryTarget& at, Vec3& slides) const override {
    if (!plain_words_ || !finite(at)) return ChainMechanism::slides_at_turns(at, slides);
    const FiveAxes axes = five_axis_at_tip(geometry_, at.p_BT, at.b, at.c);
    slides = {axes[kX], axes[kY], axes[kZ]};
    return SolveStatus::ok;
  }

  SolveStatus axes_at_turns(const RotaryTarget& at, const RotaryTarget& rate, std::span<double> axes,
                            std::span<double> axis_rates) const override {
    if (!plain_words_ || axes.size() < kFiveAxes || axis_rates.size() < kFiveAxes || !finite(at) ||
        !finite(rate))
      return ChainMechanism::axes_at_turns(at, rate, axes, axis_rates);
    const FiveAxes q = five_axis_at_tip(geometry_, at.p_BT, at.b, at.c);
    const FiveAxes q_rate = rates_at_tip(geometry_, at, rate);
    std::copy(q.begin(), q.end(), axes.begin());
    std::copy(q_rate.begin(), q_rate.end(), axis_rates.begin());
    return SolveStatus::ok;
  }

 private:
  static bool finite(const RotaryTarget& at) {
    return at.p_BT.allFinite() && std::isfinite(at.b) && std::isfinite(at.c);
  }

  struct Choice {
    FiveAxes axes{};
    int broken = 0;
    double distance = 0;  // squared, a radian as length_scale
  };

  Choice unwound(const FiveAxes& branch, const FiveAxes& from) const {
    Choice choice;
    choice.axes = branch;
    for (std::size_t i = 0; i < kFiveAxes; ++i) {
      const ChainAxis& axis = chain().axes[i];
      double& q = choice.axes[i];
      if (axis.angle) q = turn_within(q, from[i], axis);
      choice.broken += q < axis.lower || q > axis.upper;
      const double way = (q - from[i]) * (axis.angle ? description().length_scale : 1.0);
      choice.distance += way * way;
    }
    return choice;
  }

  FiveAxisGeometry geometry_;
  bool plain_words_;
};

}  // namespace

Chain five_axis_chain(const FiveAxisGeometry& geometry) {
  Chain chain;
  chain.axes.push_back(sliding_axis("x", Vec3::UnitX(), -1));
  chain.axes.push_back(sliding_axis("y", Vec3::UnitY(), 0));
  chain.axes.push_back(sliding_axis("z", Vec3::UnitZ(), 1));
  chain.axes.push_back(turning_axis("b", -Vec3::UnitY(), on_b_axis(geometry), -1));
  chain.axes.push_back(turning_axis("c", -Vec3::UnitZ(), on_c_axis(geometry), 3));
  chain.tool_axis = 2;
  chain.work_axis = 4;
  return chain;
}

SolveStatus five_axis_branches(const FiveAxisGeometry& geometry, const Pose& X_ST, double c_held,
                               FiveAxisBranches& branches) {
  if (!is_rigid(X_ST) || !std::isfinite(c_held)) return SolveStatus::bad_input;
  const Vec3 axis = tool_axis(X_ST);
  const double sine = std::hypot(axis.x(), axis.y());
  branches.turn_is_free = sine < kUpright;
  for (std::size_t n = 0; n < 2; ++n) {
    const double s = n == 0 ? 1 : -1;
    const double b = s * std::atan2(sine, axis.z());
    const double c = branches.turn_is_free ? c_held : std::atan2(s * axis.y(), s * axis.x());
    branches.axes[n] = five_axis_at_tip(geometry, X_ST.translation(), b, c);
  }
  return SolveStatus::ok;
}

Pose five_axis_pose(const FiveAxisGeometry& geometry, const FiveAxes& axes) {
  const Vec3 b_axis = on_b_axis(geometry), c_axis = on_c_axis(geometry);
  const Mat3 R_b = turn_y(axes[kB]), R_c = turn_z(axes[kC]);
  const Vec3 tilted = b_axis + R_b * (Vec3(axes[kX], axes[kY], axes[kZ]) - b_axis);
  return make_pose(Mat3(R_c * R_b), Vec3(c_axis + R_c * (tilted - c_axis)));
}

Pose five_axis_tip_pose(const Vec3& p_ST, double b, double c) {
  return make_pose(Mat3(turn_z(c) * turn_y(b)), p_ST);
}

FiveAxes five_axis_at_tip(const FiveAxisGeometry& geometry, const Vec3& p_ST, double b, double c) {
  const Vec3 b_axis = on_b_axis(geometry), c_axis = on_c_axis(geometry);
  const Vec3 turned = c_axis + turn_z(-c) * (p_ST - c_axis);
  const Vec3 slides = b_axis + turn_y(-b) * (turned - b_axis);
  return {slides.x(), slides.y(), slides.z(), b, c};
}

ChainKind five_axis_kind() {
  ChainKind kind;
  kind.name = "five-axis";
  for (const char* key : {"b_axis_x_mm", "b_axis_z_mm", "c_axis_x_mm", "c_axis_y_mm"})
    kind.parameters.push_back(
        {key, -10'000, 10'000, "line of the turning axis, seen from the work's origin"});
  kind.chain = [](std::span<const double> parameters) { return five_axis_chain(geometry_of(parameters)); };
  kind.make = [](const ChainDescription& description) -> std::unique_ptr<Mechanism> {
    return std::make_unique<FiveAxis>(description);
  };
  return kind;
}

}  // namespace understudy::kinematics
