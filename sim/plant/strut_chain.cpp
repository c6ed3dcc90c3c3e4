#include "sim/plant/strut_chain.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {

StrutChain assemble_strut(const kinematics::HexapodGeometry& geometry,
                          const kinematics::HexapodJoints& joints, const Pose& X_WB, const Pose& X_WT,
                          int strut) {
  const auto i = static_cast<std::size_t>(strut);
  StrutChain chain;
  chain.base_W = X_WB * geometry.base_joint[i];
  chain.ball_W = X_WT * geometry.platform_joint[i];
  chain.tangent_W = X_WB.linear() * Vec3::UnitZ().cross(joints.radial_axis[i]).normalized();

  const double dev = geometry.deviation;
  const Vec3 d = chain.ball_W - chain.base_W;
  const double length_squared = d.squaredNorm() - dev * dev;
  if (!(length_squared > 0))
    throw MachineError(
        fmt::format("strut {} cannot be assembled: its joints are {:.3f} mm apart, dev is {:.3f} mm",
                    strut + 1, to_mm(d.norm()), to_mm(dev)));
  chain.length = std::sqrt(length_squared);

  // Across the tangent, d is the hypotenuse of the triangle with legs dev (offset) and length * cos(beta).
  const Vec3 across = d - d.dot(chain.tangent_W) * chain.tangent_W;
  const double hypotenuse = across.norm();
  const double leg_squared = hypotenuse * hypotenuse - dev * dev;
  if (!(leg_squared > 0))
    throw MachineError(
        fmt::format("strut {} cannot be assembled: it lies along its universal joint's axis", strut + 1));
  const double leg = std::sqrt(leg_squared);
  const Vec3 along = across / hypotenuse;
  const Vec3 outward = along.cross(chain.tangent_W);  // away from the base's centre for a hanging strut
  chain.offset_W = (dev * along + leg * outward) / hypotenuse;
  chain.screw_W = (d - dev * chain.offset_W) / chain.length;
  return chain;
}

}  // namespace understudy::sim
