// Rigid shapes that collision checks, pictures and clearance all share.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "core/frames.h"

namespace understudy::geometry {

class Mesh;

/// All lengths [m]. Axes along z of the shape's own frame, origin at its centre unless said otherwise.
struct Sphere {
  double radius;
};
struct Capsule {
  double radius;
  double length;
};  ///< length between the cap centres
struct Cylinder {
  double radius;
  double length;
};
/// A truncated cone from z = 0 (radius_bottom) to z = height (radius_top).
struct Frustum {
  double radius_bottom;
  double radius_top;
  double height;
};
struct Box {
  Vec3 size;
};
struct MeshShape {
  std::shared_ptr<const Mesh> mesh;
};

struct Shape {
  std::string name;
  std::variant<Sphere, Capsule, Cylinder, Frustum, Box, MeshShape> form;
  Pose X_FS = Pose::Identity();  ///< pose of the shape in the frame that its owner states
};

/// Capsule between two points.
Shape capsule_between(std::string name, const Vec3& a, const Vec3& b, double radius);

}  // namespace understudy::geometry
