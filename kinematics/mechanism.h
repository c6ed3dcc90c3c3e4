// What every machine's kinematics offers to the rest: poses to axes and back, rates, limits.
// Poses are X_BT: the tool seen from the frame B that the work stands in: the machine's base where the table
// stands still, the table itself where axes move it. Axes are in SI (m or rad), in the machine's order.
// No function here throws, allocates (but for `check`) or returns NaN: a SolveStatus says why there is no
// answer.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/frames.h"
#include "kinematics/axis_vector.h"
#include "kinematics/rotary_words.h"

namespace understudy::kinematics {

/// Condition numbers are not told apart above this.
constexpr double kSingularCondition = 1e7;

enum class [[nodiscard]] SolveStatus{ok, unreachable, singular, not_converged, bad_input};
const char* to_string(SolveStatus s);

enum class LimitKind {
  strut_length,
  joint_angle,
  joint_limit,
  screw_distance,
  axis_velocity,
  axis_acceleration,
  singularity,
  unreachable
};
const char* to_string(LimitKind kind);

/// One limit that a pose or a motion breaks.
struct LimitViolation {
  LimitKind kind;
  std::string part;  ///< "strut 3", "ball joint 2", "struts 1 and 6"
  double value = 0;  ///< SI
  double limit = 0;  ///< SI
  std::string unit;  ///< SI unit of both: "m", "rad", "m/s", "1"
};
/// "strut 3 is 241.7 mm, longer than 240.0 mm": in the units of reports.
std::string to_string(const LimitViolation& violation);

/// What an axis may take, without an end where infinite.
struct AxisRange {
  double lower = 0, upper = 0;  ///< [m] or [rad]
};

class Mechanism {
 public:
  virtual ~Mechanism() = default;

  virtual int axis_count() const = 0;
  virtual std::string axis_name(int axis) const = 0;  ///< as in CSV headers without unit: "l1", "j1", "x"
  virtual bool axis_is_angle(int axis) const = 0;
  virtual AxisRange axis_range(int axis) const = 0;
  virtual Pose home() const = 0;  ///< X_BT
  /// False where the tool's rotation about its own axis (z of T) is not the machine's to choose: inverse()
  /// and axis_rates() then disregard it, and forward() tells the one that the axes make.
  virtual bool follows_spin() const { return true; }

  /// Axis positions for a pose; `previous` picks the branch where there are several, and the turn of an axis
  /// without end. Empty: home. A solution beyond an axis range is still a solution: check() says so.
  virtual SolveStatus inverse(const Pose& X_BT, std::span<const double> previous,
                              std::span<double> axes) const = 0;
  /// Tool pose for axis positions, on the branch of `seed`.
  virtual SolveStatus forward(std::span<const double> axes, const Pose& seed, Pose& X_BT) const = 0;
  /// d(axes)/d(twist): row per axis; twist = (velocity of the tip, angular velocity), both in B. Of the
  /// smallest norm where a twist leaves a choice. `singular`: rates are filled all the same, for the twists
  /// that the machine can still follow.
  virtual SolveStatus axis_rates(const Pose& X_BT, std::span<const double> axes,
                                 Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const = 0;
  /// Condition number of axis_rates with its angular columns divided by the tool's own size, so that both
  /// halves are lengths; kSingularCondition where it is singular or there is no solution.
  virtual double condition_number(const Pose& X_BT, std::span<const double> axes) const = 0;
  /// Appends every limit that the pose breaks (lengths, joint angles, distances, conditioning). `axes` as
  /// inverse() gave them, or empty where it has no solution.
  virtual void check(const Pose& X_BT, std::span<const double> axes,
                     std::vector<LimitViolation>& violations) const = 0;

  /// The one or two rotary words of a machine that has them, else none. The functions below are for the
  /// former, `bad_input` elsewhere.
  virtual std::span<const AxisWord> rotary_words() const { return {}; }
  /// Whether X Y Z can state the slides of this machine.
  virtual bool has_slide_words() const { return false; }
  /// The pose with the tip and both turns as given (tool-centre-point coordinates).
  virtual SolveStatus pose_at_turns(const RotaryTarget& at, Pose& X_BT) const;
  /// How those of them that carry the work and those that carry the tool turn the latter, seen from the work:
  /// R_BT = table * head * R_BT of all axes at 0.
  virtual SolveStatus parts_at_turns(const RotaryTarget& at, Mat3& table, Mat3& head) const;
  /// The pose with the slides and both turns as given (machine coordinates), and the slides of a tip; for
  /// machines with slide words.
  virtual SolveStatus pose_at_slides(const RotaryTarget& at, Pose& X_BT) const;
  virtual SolveStatus slides_at_turns(const RotaryTarget& at, Vec3& slides) const;
  /// The axes that hold the tip there with the turns as they are, branch included, singular or not, and what
  /// they do while tip and turns move at `rate`. `axes` holds near ones on entry: the branch of an arm.
  virtual SolveStatus axes_at_turns(const RotaryTarget& at, const RotaryTarget& rate, std::span<double> axes,
                                    std::span<double> axis_rates) const;
};

}  // namespace understudy::kinematics
