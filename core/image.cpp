#include "core/image.h"

#include <algorithm>
#include <utility>

namespace understudy {
namespace {

/// Begin and size of what lies in `within`. A region of a user's may end beyond what an int holds.
std::pair<int, int> clipped(int begin, int size, int within, int within_size) {
  const std::int64_t last = std::int64_t{within} + within_size;
  const std::int64_t from = std::clamp<std::int64_t>(begin, within, last);
  const std::int64_t to = std::clamp<std::int64_t>(std::int64_t{begin} + size, from, last);
  return {static_cast<int>(from), static_cast<int>(to - from)};
}

}  // namespace

Region clipped(const Region& region, const Region& within) {
  const auto [x, width] = clipped(region.x, region.width, within.x, within.width);
  const auto [y, height] = clipped(region.y, region.height, within.y, within.height);
  return {x, y, width, height};
}

std::optional<Vec2> Camera::project(const Vec3& p_C) const {
  if (!(p_C.z() > 0)) return std::nullopt;
  const double x = p_C.x() / p_C.z();
  const double y = p_C.y() / p_C.z();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * k2);
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return Vec2(centre_px.x() + focal_px * xd, centre_px.y() + focal_px * yd);
}

}  // namespace understudy
