// The closed form works on sines and cosines only; the angles of all branches are then taken in one
// vectorised pass.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chain/angles.h"
#include "kinematics/chain/arm.h"
#include "kinematics/chain/chain_mechanism.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;

/// A direction of less length [m, or 1] is rounding and has no angle.
constexpr double kNoDirection = 1e-13;
/// The sine of an elbow that counts as straight: its branches then lie within rounding of each other.
constexpr double kStraightElbow = 3e-8;

// Slots of the angles of one pose. Postures are 2 back + bent_up.
constexpr int kQ1 = 0, kElbow = 1, kQ2 = 3, kQ4 = 7, kQ5 = 11, kQ6 = 15, kForearm = 19, kSlots = 20;
constexpr int kPostures = 4;

struct ArmSines {
  bool exists[kPostures];
  bool wrist_straight[kPostures];
};

/// An angle by its sine and cosine.
struct Turn {
  double sine, cosine;
};

/// A pair of sine and cosine for each slot.
struct Slots {
  double* sine;
  double* cosine;
  void set(int slot, double s, double c) const {
    sine[slot] = s;
    cosine[slot] = c;
  }
  void hold(int slot, std::span<const double> previous, std::size_t axis) const {
    const double q = axis < previous.size() && std::isfinite(previous[axis]) ? previous[axis] : 0.0;
    set(slot, std::sin(q), std::cos(q));
  }
};

/// The orientation that the wrist must make, and the upper arm's place for it.
struct Target {
  Vec3 flange_z, flange_x, flange_y;  // of F in B
  Vec3 p_BW;                          // wrist centre
};

Target wrist_target(const ArmGeometry& g, const Pose& X_BT) {
  const Mat3 R_BF = X_BT.linear() * g.X_FT.linear().transpose();
  return {R_BF.col(2), R_BF.col(0), R_BF.col(1),
          X_BT.translation() - R_BF * (g.X_FT.translation() + Vec3(0, 0, g.d6))};
}

/// j4, j5, j6 turn about x, y, x of the forearm: M = Rx(q4) Ry(q5) Rx(q6) of what is left to turn. q6 comes
/// from what q4 leaves, not from M alone: so their sum stays exact where each of them is hardly defined.
/// `theta` = q2 + q3.
bool place_wrist(const Target& to, const Turn& q1, const Turn& theta, std::span<const double> previous,
                 int posture, const Slots& slots) {
  const auto [s1, c1] = q1;
  const auto [s_theta, c_theta] = theta;
  const Vec3 x(c1 * c_theta, s1 * c_theta, -s_theta), y(-s1, c1, 0), z(c1 * s_theta, s1 * s_theta, c_theta);
  const double m00 = x.dot(to.flange_z), m10 = y.dot(to.flange_z), m20 = z.dot(to.flange_z);
  const double s5 = std::sqrt(m10 * m10 + m20 * m20);
  const bool straight = s5 < kNoDirection;
  if (straight) {
    slots.hold(kQ4 + posture, previous, 3);
    slots.set(kQ5 + posture, 0, m00);
  } else {
    slots.set(kQ4 + posture, m10 / s5, -m20 / s5);
    slots.set(kQ5 + posture, s5, m00);
  }
  const Vec3 turned = slots.cosine[kQ4 + posture] * y + slots.sine[kQ4 + posture] * z;
  slots.set(kQ6 + posture, -turned.dot(to.flange_x), -turned.dot(to.flange_y));
  return straight;
}

/// One of the two turns of j1 that bring the wrist centre into the plane of j2 and j3.
struct Shoulder {
  Turn q1;
  double u, w;  // [m], wrist centre in that plane, forwards and up from axis 2
  bool back;    // the wrist centre lies behind axis 2
};

/// Postures of one shoulder.
void place_plane(const ArmGeometry& g, const Target& to, const Shoulder& shoulder,
                 std::span<const double> previous, const Slots& slots, ArmSines& found) {
  const auto [q1, u, w, back] = shoulder;
  const double forearm = std::sqrt(g.a3 * g.a3 + g.d4 * g.d4);
  const double sum = g.a2 + forearm, difference = g.a2 - forearm;
  const double reach2 = u * u + w * w;
  const double short_of_sum = sum * sum - reach2, over_difference = reach2 - difference * difference;
  const double slack = 2 * sum * kNoDirection;
  if (!(short_of_sum >= -slack && over_difference >= -slack)) return;

  const double per = 1 / (2 * g.a2 * forearm);
  double s_elbow = std::sqrt(std::max(short_of_sum, 0.0) * std::max(over_difference, 0.0)) * per;
  double c_elbow = (reach2 - g.a2 * g.a2 - forearm * forearm) * per;
  const bool straight = s_elbow < kStraightElbow;
  if (straight) {
    s_elbow = 0;
    c_elbow = c_elbow < 0 ? -1 : 1;
  }
  slots.set(kElbow + back, s_elbow, c_elbow);
  const double s_forearm = g.d4 / forearm, c_forearm = g.a3 / forearm;  // q3 = elbow - atan2(d4, a3)
  for (int bent_up = 0; bent_up < (straight ? 1 : 2); ++bent_up) {
    const int posture = 2 * back + bent_up;
    const double s = bent_up ? -s_elbow : s_elbow;
    const double along = g.a2 + forearm * c_elbow, across = forearm * s;
    const double length = std::sqrt((along * along + across * across) * reach2);
    if (length > kNoDirection * kNoDirection)
      slots.set(kQ2 + posture, (along * u - across * w) / length, (along * w + across * u) / length);
    else
      slots.hold(kQ2 + posture, previous, 1);
    const double s2 = slots.sine[kQ2 + posture], c2 = slots.cosine[kQ2 + posture];
    const double s3 = s * c_forearm - c_elbow * s_forearm, c3 = c_elbow * c_forearm + s * s_forearm;
    found.exists[posture] = true;
    found.wrist_straight[posture] =
        place_wrist(to, q1, {s2 * c3 + c2 * s3, c2 * c3 - s2 * s3}, previous, posture, slots);
  }
}

void place_arm(const ArmGeometry& g, const Pose& X_BT, std::span<const double> previous, const Slots& slots,
               ArmSines& found) {
  found = {};
  for (int slot = 0; slot < kSlots; ++slot) slots.set(slot, 0, 1);
  if (!is_pose(X_BT)) return;
  const Target to = wrist_target(g, X_BT);
  const double x = to.p_BW.x(), y = to.p_BW.y(), w = to.p_BW.z() - g.d1;
  const double r = std::sqrt(x * x + y * y);
  const bool on_axis_1 = r < kNoDirection;
  if (on_axis_1)
    slots.hold(kQ1, previous, 0);
  else
    slots.set(kQ1, y / r, x / r);
  slots.set(kForearm, g.d4, g.a3);
  const double s1 = slots.sine[kQ1], c1 = slots.cosine[kQ1];
  place_plane(g, to, {{s1, c1}, r - g.a1, w, false}, previous, slots, found);
  if (!on_axis_1) place_plane(g, to, {{-s1, -c1}, -r - g.a1, w, true}, previous, slots, found);
}

double half_turn_on(double q) { return q > 0 ? q - kPi : q + kPi; }
double wrapped(double q) { return q > kPi ? q - 2 * kPi : (q <= -kPi ? q + 2 * kPi : q); }

int gather(const ArmSines& found, const double* angle, std::span<ArmSolution, kArmBranches> solutions) {
  std::size_t count = 0;
  for (int posture = 0; posture < kPostures; ++posture) {
    if (!found.exists[posture]) continue;
    const bool back = posture >= 2, bent_up = posture % 2 == 1;
    ArmSolution& s = solutions[count++];
    s.axes[0] = back ? half_turn_on(angle[kQ1]) : angle[kQ1];
    s.axes[1] = angle[kQ2 + posture];
    const double elbow = angle[kElbow + back];
    s.axes[2] = wrapped((bent_up ? -elbow : elbow) - angle[kForearm]);
    for (int k = 0; k < 3; ++k) s.axes[3 + k] = angle[kQ4 + 4 * k + posture];
    s.branch = {back, bent_up, false};
    if (found.wrist_straight[posture]) continue;
    ArmSolution& other = solutions[count++];
    other = s;
    other.axes[3] = half_turn_on(s.axes[3]);
    other.axes[4] = -s.axes[4];
    other.axes[5] = half_turn_on(s.axes[5]);
    other.branch.flipped = true;
  }
  return static_cast<int>(count);
}

}  // namespace

int arm_branches(const ArmGeometry& geometry, const Pose& X_BT,
                 std::span<ArmSolution, kArmBranches> solutions, std::span<const double> previous) {
  double sine[kSlots], cosine[kSlots], angle[kSlots];
  ArmSines found;
  place_arm(geometry, X_BT, previous, {sine, cosine}, found);
  angles_of(sine, cosine, angle, kSlots);
  return gather(found, angle, solutions);
}

}  // namespace understudy::kinematics
