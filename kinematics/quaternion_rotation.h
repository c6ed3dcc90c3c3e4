// The rotation of a quaternion for one pose (Number = double) or for several side by side (Number = a vector
// of the compiler). No Eigen here, for the reason given in hexapod/hexapod_simd.h.
#pragma once

namespace understudy::kinematics::simd {

/// The rotation of a quaternion of nearly unit length, without a root. False: it is farther than `unit`
/// from length 1.
template <class Number>
auto rotation(const Number& w, const Number& x, const Number& y, const Number& z, double unit,
              Number (&R)[3][3]) {
  const Number squared = w * w + x * x + y * y + z * z;
  const Number s = 2.0 / squared;
  R[0][0] = 1.0 - s * (y * y + z * z);
  R[0][1] = s * (x * y - w * z);
  R[0][2] = s * (x * z + w * y);
  R[1][0] = s * (x * y + w * z);
  R[1][1] = 1.0 - s * (x * x + z * z);
  R[1][2] = s * (y * z - w * x);
  R[2][0] = s * (x * z - w * y);
  R[2][1] = s * (y * z + w * x);
  R[2][2] = 1.0 - s * (x * x + y * y);
  return (squared >= (1 - unit) * (1 - unit)) & (squared <= (1 + unit) * (1 + unit));
}

}  // namespace understudy::kinematics::simd
