#include "calibration/table/measured_orientation.h"

#include <cmath>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

Quat quaternion_of(const OrientationReading& reading, const std::vector<double>& q) {
  return reading.order == "xyzw" ? Quat(q[3], q[0], q[1], q[2]) : Quat(q[0], q[1], q[2], q[3]);
}

Mat3 matrix_of(const std::vector<double>& m) {
  Mat3 R;
  R << m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8];
  return R;
}

Mat3 euler_rotation(const OrientationReading& reading, const std::vector<double>& angles) {
  Mat3 R = Mat3::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Mat3 turn = exp_rotation(reading.unit * angles[i] * Vec3::Unit(reading.order[i] - 'x'));
    R = reading.fixed ? Mat3(turn * R) : Mat3(R * turn);
  }
  return R;
}

}  // namespace

std::size_t numbers_of(OrientationForm form) {
  if (form == OrientationForm::quaternion) return 4;
  return form == OrientationForm::matrix ? 9 : 3;
}

Mat3 orientation_of(const OrientationReading& reading, const std::vector<double>& numbers) {
  switch (reading.form) {
    case OrientationForm::quaternion:
      return quaternion_of(reading, numbers).normalized().toRotationMatrix();
    case OrientationForm::euler:
      return euler_rotation(reading, numbers);
    case OrientationForm::rotation_vector:
      return exp_rotation(reading.unit * Vec3(numbers[0], numbers[1], numbers[2]));
    case OrientationForm::matrix:
      break;
  }
  return nearest_rotation(matrix_of(numbers));
}

double off_rotation(const OrientationReading& reading, const std::vector<double>& numbers) {
  if (reading.form == OrientationForm::quaternion)
    return std::abs(quaternion_of(reading, numbers).norm() - 1);
  if (reading.form != OrientationForm::matrix) return 0;
  const Mat3 R = matrix_of(numbers);
  if (R.determinant() < 0) return 2;
  return (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff();
}

std::string to_string(const OrientationReading& reading) {
  switch (reading.form) {
    case OrientationForm::quaternion:
      return "quaternions " + reading.order;
    case OrientationForm::euler:
      return fmt::format("Euler angles in {}, order {}, axes {}", reading.unit == 1 ? "rad" : "deg",
                         reading.order, reading.fixed ? "fixed" : "moving");
    case OrientationForm::rotation_vector:
      return fmt::format("rotation vectors in {}", reading.unit == 1 ? "rad" : "deg");
    case OrientationForm::matrix:
      break;
  }
  return "matrices";
}

std::vector<OrientationReading> other_readings(const OrientationReading& reading) {
  std::vector<OrientationReading> others;
  OrientationReading other = reading;
  if (reading.form == OrientationForm::quaternion) {
    other.order = reading.order == "wxyz" ? "xyzw" : "wxyz";
    others.push_back(other);
  }
  if (reading.form == OrientationForm::euler || reading.form == OrientationForm::rotation_vector)
    for (const double unit : {1.0, kDegree})
      for (const OrientationForm form : {OrientationForm::euler, OrientationForm::rotation_vector}) {
        other.form = form;
        other.unit = unit;
        if (form == OrientationForm::rotation_vector) {
          others.push_back(other);
          continue;
        }
        for (const char* order :
             {"xyz", "zyx", "zxz", "zyz", "xzy", "yxz", "yzx", "zxy", "xyx", "xzx", "yxy", "yzy"})
          for (const bool fixed : {false, true}) {
            other.order = order;
            other.fixed = fixed;
            others.push_back(other);
          }
      }
  return others;
}

}  // namespace understudy::calibration
