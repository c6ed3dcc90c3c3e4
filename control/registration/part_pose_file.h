// Where a clamped part stands, in a file: what `register` found, for the prints on it (docs/registration.md).
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/yaml/map_schema.h"

namespace understudy::control {

struct PartPose {
  // Names are for people; checksums, where given, are of the bytes of the shape's STL and of the machine
  // file.
  std::string part, part_sha256, machine, machine_sha256;
  Pose X_W = Pose::Identity();      ///< p_W = X_W * p_drawn
  Vec3 reference_W{0, 0, 0};        ///< [m]
  Mat6 covariance = Mat6::Zero();   ///< of a shift of the reference [m] and a turn [rad], in W
  std::vector<std::string> unseen;  ///< freedoms that are as drawn, in words
};

/// `command`: that found it.
std::string write_part_pose(const PartPose& pose, const std::string& command);

/// Throws InputError with file, line, key and limit: a quaternion that is not of unit length, a covariance
/// that is not positive semi-definite, a pose farther off than registration can find.
PartPose read_part_pose(const std::string& file);

MapSchema part_pose_schema();

}  // namespace understudy::control
