// Orientations as devices and robots write them.
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"

namespace understudy::calibration {

enum class OrientationForm { quaternion, euler, rotation_vector, matrix };

struct OrientationReading {
  OrientationForm form = OrientationForm::quaternion;
  /// Of a quaternion "wxyz" or "xyzw"; of Euler angles the axes in the order of the columns: "xyz", "zyx",
  /// "zxz".
  std::string order = "wxyz";
  /// Of Euler angles: the axes stand still, R = R3 R2 R1; else they turn along, R = R1 R2 R3.
  bool fixed = false;
  double unit = 1;  ///< [rad] of one; of angles and rotation vectors
};

/// Numbers that the form has.
std::size_t numbers_of(OrientationForm form);

/// A rotation; a quaternion's length and a matrix' deviation from a rotation are left out of it.
Mat3 orientation_of(const OrientationReading& reading, const std::vector<double>& numbers);

/// How far the numbers are from a rotation: of a quaternion | |q| - 1 |, of a matrix the largest entry of R^T
/// R
/// - I, and 2 for a mirror; 0 for the others.
double off_rotation(const OrientationReading& reading, const std::vector<double>& numbers);

/// "Euler angles zyx about axes that turn along", for messages.
std::string to_string(const OrientationReading& reading);

/// All other orders, and fixed against moving axes, for the same numbers.
std::vector<OrientationReading> other_readings(const OrientationReading& reading);

}  // namespace understudy::calibration
