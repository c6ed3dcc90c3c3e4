#include "toolpath/planners/drawing_on_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr double kFarthest = 5 * kMillimetre;  // as of a curve
constexpr double kStep = 1 * kMillimetre;      // of straight lines over a curved surface
constexpr double kLevel = 1e-6;                // of a normal, its level part

struct Box {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

Box box_of(const std::vector<std::vector<Vec2>>& strokes) {
  Box box;
  for (const auto& stroke : strokes)
    for (const Vec2& p : stroke) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  return box;
}

/// Columns: the drawing's x and y and the normal.
Mat3 axes_on(const Vec3& normal, double turn) {
  // A normal leans downhill, so that uphill is to the left of its level part turned by a right angle to the
  // left.
  Vec3 across = Vec3::UnitX();
  if (normal.head<2>().norm() > kLevel) across = Vec3(-normal.y(), normal.x(), 0).normalized();
  across = Eigen::AngleAxisd(turn, normal) * across;
  Mat3 axes;
  axes << across, normal.cross(across), normal;
  return axes;
}

}  // namespace

std::vector<std::vector<Vec3>> drawing_on_surface(const geometry::Mesh& mesh,
                                                  const std::vector<std::vector<Vec2>>& strokes,
                                                  const DrawingPlace& place) {
  const Box box = box_of(strokes);
  const double width = box.high.x() - box.low.x();
  if (!(width > 0) && place.width > 0)
    throw InputError("the drawing has no width that could be stretched to the one asked for");
  const double scale = place.width > 0 ? place.width / width : 1;
  const geometry::SurfacePoint middle = mesh.nearest(place.point_W);
  if (middle.distance > kFarthest)
    throw InputError(fmt::format("the drawing's place {} is {:.3f} mm from the part, more than {:.0f} mm",
                                 in_mm(place.point_W), to_mm(middle.distance), to_mm(kFarthest)));
  const Mat3 axes = axes_on(middle.normal, place.turn);
  const double above = (mesh.upper() - mesh.lower()).norm();
  const auto project = [&](const Vec2& p) {
    const Vec2 q = scale * (p - 0.5 * (box.low + box.high));
    const Vec3 at = middle.position + q.x() * axes.col(0) + q.y() * axes.col(1);
    const auto hit = mesh.ray_hit(at + above * axes.col(2), -axes.col(2), 2 * above);
    if (!hit)
      throw InputError(
          fmt::format("the drawing reaches beyond the part: nothing is below {}, {:.2f} mm beside its middle",
                      in_mm(at), to_mm(q.norm())));
    return hit->position;
  };
  std::vector<std::vector<Vec3>> curves;
  for (const auto& stroke : strokes) {
    std::vector<Vec3> curve{project(stroke.front())};
    for (std::size_t i = 1; i < stroke.size(); ++i) {
      const Vec2 way = stroke[i] - stroke[i - 1];
      const int parts = step_count(scale * way.norm(), kStep);
      for (int k = 1; k <= parts; ++k) curve.push_back(project(stroke[i - 1] + way * k / parts));
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace understudy::toolpath
