#include "kinematics/chain/rods.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace understudy::kinematics {
namespace {

Vec3 joint(const Chain& chain, std::span<const double> slides, std::size_t rod) {
  const ChainAxis& axis = chain.axes[rod];
  return axis.point + slides[rod] * axis.direction;
}

}  // namespace

SolveStatus rods_meet(const Chain& chain, std::span<const double> slides, Vec3& p_O) {
  const Vec3 first = joint(chain, slides, 0);
  const Vec3 second = joint(chain, slides, 1) - first, third = joint(chain, slides, 2) - first;
  const double d = second.norm();
  const Vec3 x = d > 0 ? Vec3(second / d) : Vec3(Vec3::Zero());
  const double i = x.dot(third);
  const Vec3 across = third - i * x;
  const double j = across.norm();
  constexpr double kLine = 1e-9;  // [m], of three joints that are nearly on one
  p_O = first;
  if (!(d > kLine && j > kLine)) return SolveStatus::unreachable;
  const Vec3 y = across / j;
  // Three spheres: their radii give the place within the plane of the centres, the rest is height.
  const double r1 = chain.rods[0] * chain.rods[0], r2 = chain.rods[1] * chain.rods[1],
               r3 = chain.rods[2] * chain.rods[2];
  const double along = (r1 - r2 + d * d) / (2 * d);
  const double aside = (r1 - r3 + i * i + j * j - 2 * i * along) / (2 * j);
  const double height2 = r1 - along * along - aside * aside;
  Vec3 ahead = Vec3::Zero();
  for (const ChainAxis& axis : chain.axes) ahead += axis.direction;
  Vec3 z = x.cross(y);
  if (z.dot(ahead) > 0) z = -z;
  p_O = first + along * x + aside * y + std::sqrt(std::max(0.0, height2)) * z;
  return height2 >= 0 ? SolveStatus::ok : SolveStatus::unreachable;
}

SolveStatus slides_of_rods(const Chain& chain, const Vec3& p_O, std::span<double> slides) {
  PerAxis<double> found{};
  for (std::size_t i = 0; i < kRods; ++i) {
    const ChainAxis& axis = chain.axes[i];
    const Vec3 w = p_O - axis.point;
    const double along = w.dot(axis.direction);
    const double squared = chain.rods[i] * chain.rods[i] - (w - along * axis.direction).squaredNorm();
    if (!(squared >= 0)) return SolveStatus::unreachable;
    found[i] = along + std::sqrt(squared);
  }
  std::copy_n(found.begin(), kRods, slides.begin());
  return SolveStatus::ok;
}

Mat3 rod_vectors(const Chain& chain, std::span<const double> slides, const Vec3& p_O) {
  Mat3 rods;
  for (int i = 0; i < kRods; ++i)
    rods.row(i) = (p_O - joint(chain, slides, static_cast<std::size_t>(i))).transpose();
  return rods;
}

Mat3 rod_jacobian(const Chain& chain, const Mat3& rods) {
  Mat3 pushed = Mat3::Zero();
  for (int i = 0; i < kRods; ++i) pushed(i, i) = rods.row(i).dot(chain.axes[std::size_t(i)].direction);
  constexpr double kFlat = 1e-9;  // of the volume of three rods at right angles
  const double volume = rods.row(0).norm() * rods.row(1).norm() * rods.row(2).norm();
  if (!(std::abs(rods.determinant()) > kFlat * volume)) return Mat3::Zero();
  return rods.inverse() * pushed;
}

double rod_lean(const Chain& chain, const Mat3& rods, int rod) {
  const Vec3 along = -rods.row(rod).transpose(), direction = chain.axes[std::size_t(rod)].direction;
  return std::atan2(along.cross(direction).norm(), along.dot(direction));
}

double rod_span(const Chain& chain, const Vec3& p_O, int rod) {
  const ChainAxis& axis = chain.axes[std::size_t(rod)];
  const Vec3 w = p_O - axis.point;
  return (w - w.dot(axis.direction) * axis.direction).norm();
}

}  // namespace understudy::kinematics
