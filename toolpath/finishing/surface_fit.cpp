#include "toolpath/finishing/surface_fit.h"

#include <Eigen/QR>

#include <cmath>

namespace understudy::toolpath {

Vec3 fitted_normal(const geometry::Mesh& mesh, const geometry::SurfacePoint& at, double reach) {
  constexpr int kHalf = 2;  // places each way
  constexpr int kUnknowns = 6, kPlaces = (2 * kHalf + 1) * (2 * kHalf + 1);
  constexpr int kEnough = 12;  // twice the unknowns
  // Along the outline and across it, so that an upright wall stays upright whatever the outline does.
  const Vec3 level = Vec3::UnitZ().cross(at.normal),
             u = level.norm() > 1e-6 ? level.normalized() : Vec3::UnitX();
  Mat3 R;
  R << u, at.normal.cross(u).normalized(), at.normal;
  R.col(0) = R.col(1).cross(R.col(2));
  Eigen::Matrix<double, kPlaces, kUnknowns> A;
  Eigen::Matrix<double, kPlaces, 1> heights;
  int count = 0;
  for (int i = -kHalf; i <= kHalf; ++i)
    for (int j = -kHalf; j <= kHalf; ++j) {
      const Vec3 place = at.position + reach / kHalf * (i * R.col(0) + j * R.col(1));
      const geometry::SurfacePoint near = mesh.nearest(place);
      if (near.normal.dot(at.normal) < std::cos(geometry::kCreaseAngle)) continue;
      const Vec3 q = R.transpose() * (near.position - at.position) / reach;
      A.row(count) << 1, q.x(), q.y(), q.x() * q.x(), q.x() * q.y(), q.y() * q.y();
      heights[count++] = q.z();
    }
  if (count < kEnough) return at.normal;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.topRows(count));
  if (qr.rank() < kUnknowns) return at.normal;
  const Eigen::VectorXd fit = qr.solve(heights.head(count));
  return (R * Vec3(-fit[1], -fit[2], 1)).normalized();
}

}  // namespace understudy::toolpath
