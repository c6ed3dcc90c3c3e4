#include "sim/plant/quasistatic/strut_swing.h"

#include <cmath>

namespace understudy::sim {
namespace {

/// Rates of the two joints and of the length for a velocity of the ball joint in M.
struct JointRates {
  double alpha, beta, length;
};

// d' = omega x d + length' z with omega = (beta', alpha' t_y, alpha' t_z).
JointRates joint_rates(const StrutSwing& s, const Vec3& v_M) {
  const double alpha = v_M.x() * s.per_turn;
  const double beta = (alpha * s.tangent_M.z() * s.deviation - v_M.y()) * s.per_length;
  return {alpha, beta, v_M.z() + v_M.x() * s.deviation * s.per_length};
}

Vec3 turning(const StrutSwing& s, const JointRates& rates) {
  return rates.alpha * s.tangent_M + rates.beta * Vec3::UnitX();
}

/// Force at the ball joint that does the work of a moment on the motor, for every swing.
Vec3 at_ball(const StrutSwing& s, const Vec3& moment_M) {
  const double about_tangent = moment_M.dot(s.tangent_M);
  return {(about_tangent + moment_M.x() * s.tangent_M.z() * s.deviation * s.per_length) * s.per_turn,
          -moment_M.x() * s.per_length, 0};
}

}  // namespace

bool find_swing(const Vec3& d_B, const Vec3& tangent_B, double deviation, StrutSwing& swing) {
  const double dev2 = deviation * deviation;
  const double squared = d_B.squaredNorm() - dev2;
  const Vec3 across = d_B - d_B.dot(tangent_B) * tangent_B;
  const double hypotenuse2 = across.squaredNorm();
  if (!(squared > 0 && hypotenuse2 > dev2)) return false;
  // The offset is perpendicular to the tangent and stands off by dev (assemble_strut).
  const double leg = std::sqrt(hypotenuse2 - dev2);
  const Vec3 offset = (deviation * across + leg * across.cross(tangent_B)) / hypotenuse2;
  swing.length = std::sqrt(squared);
  swing.deviation = deviation;
  const Vec3 screw = (d_B - deviation * offset) / swing.length;
  swing.R_BM << offset, screw.cross(offset), screw;
  swing.tangent_M = swing.R_BM.transpose() * tangent_B;
  swing.per_length = 1 / swing.length;
  swing.per_turn = 1 / (swing.tangent_M.y() * swing.length);
  return true;
}

Vec3 swing_force(const StrutSwing& s, const SwingingBody& body, const Vec3& v_B, const Vec3& a_B,
                 const Vec3& gravity_B) {
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ(), d(s.deviation, 0, s.length);
  const JointRates rates = joint_rates(s, s.R_BM.transpose() * v_B);
  const Vec3 omega = turning(s, rates);
  // The second axis turns with the first: beta' x' = alpha' beta' (t x x).
  const Vec3 carried = rates.alpha * rates.beta * s.tangent_M.cross(x);
  const Vec3 bias = carried.cross(d) + omega.cross(omega.cross(d)) + 2 * rates.length * omega.cross(z);
  const Vec3 omega_rate = carried + turning(s, joint_rates(s, s.R_BM.transpose() * a_B - bias));

  const Vec3 centre = s.deviation * x;
  const Vec3 acceleration = omega_rate.cross(centre) + omega.cross(omega.cross(centre));
  const Vec3 force = body.mass * (s.R_BM.transpose() * gravity_B - acceleration);
  return s.R_BM * at_ball(s, centre.cross(force) - body.moment * omega_rate);
}

Mat3 swing_inertia(const StrutSwing& s, const SwingingBody& body) {
  const Vec3 centre = s.deviation * Vec3::UnitX();
  Mat3 inertia_M = Mat3::Zero();
  for (int k = 0; k < 2; ++k) {  // along the screw nothing swings
    const Vec3 omega = turning(s, joint_rates(s, Vec3::Unit(k)));
    const Vec3 momentum = body.moment * omega + body.mass * centre.cross(omega.cross(centre));
    inertia_M.col(k) = at_ball(s, momentum);
  }
  return s.R_BM * inertia_M * s.R_BM.transpose();
}

}  // namespace understudy::sim
