#include "sim/distance/face_distance.h"

namespace understudy::sim {
namespace {

template <typename Core>
std::optional<Separation> over_face(const Core& core, double radius, const Pose& X_BS, const Vec3& half) {
  const Mat3 R_SB = X_BS.linear().transpose();
  double out = 0;  // of the face that the solid is farthest out of
  Vec3 normal = Vec3::Zero(), nearest = Vec3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 outward = side * Vec3::Unit(i);
      const Vec3 p = X_BS * core.farthest(R_SB * -outward);
      const double distance = outward.dot(p) - half[i] - radius;
      if (distance <= out) continue;
      out = distance;
      normal = outward;
      nearest = p;
    }
  }
  if (out <= 0) return std::nullopt;
  const Vec3 foot = nearest - (out + radius) * normal;
  const Vec3 beyond = (foot.cwiseAbs() - half).cwiseProduct(Vec3::Ones() - normal.cwiseAbs());
  if (beyond.maxCoeff() > 0) return std::nullopt;
  return Separation{out, foot};
}

}  // namespace

std::optional<Separation> distance_over_face(const ConvexSolid& solid, const Pose& X_BS, const Vec3& half) {
  return std::visit([&](const auto& core) { return over_face(core, solid.radius, X_BS, half); }, solid.core);
}

std::optional<Separation> distance_over_face(const HullCore& solid, const Pose& X_BS, const Vec3& half) {
  return over_face(solid, 0, X_BS, half);
}

}  // namespace understudy::sim
