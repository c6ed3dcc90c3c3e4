#include "sim/distance/convex_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace understudy::sim {
namespace {

struct Project {
  Vec2 point;
  double distance;
};

Project onto_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  const Vec2 q = a + t * ab;
  return {q, (p - q).norm()};
}

// The frustum's section in (distance from the axis, z): the nearest point of its outline.
Project onto_outline(const FrustumCore& f, const Vec2& p) {
  const Vec2 low(f.radius_low, f.low), high(f.radius_high, f.high);
  Project best = onto_segment(p, low, high);
  for (const Project& other :
       {onto_segment(p, Vec2(0, f.low), low), onto_segment(p, Vec2(0, f.high), high)}) {
    if (other.distance < best.distance) best = other;
  }
  return best;
}

bool inside(const FrustumCore& f, const Vec2& p) {
  const double share = (p.y() - f.low) / (f.high - f.low);
  return share >= 0 && share <= 1 && p.x() <= f.radius_low + (f.radius_high - f.radius_low) * share;
}

Vec2 section_of(const Vec3& p) { return {std::hypot(p.x(), p.y()), p.z()}; }

}  // namespace

Vec3 PointCore::farthest(const Vec3&) const { return Vec3::Zero(); }
Vec3 PointCore::nearest(const Vec3&) const { return Vec3::Zero(); }
double PointCore::depth(const Vec3&) const { return 0; }

Vec3 SegmentCore::farthest(const Vec3& direction) const { return {0, 0, direction.z() > 0 ? half : -half}; }
Vec3 SegmentCore::nearest(const Vec3& p) const { return {0, 0, std::clamp(p.z(), -half, half)}; }
double SegmentCore::depth(const Vec3&) const { return 0; }

Vec3 FrustumCore::farthest(const Vec3& direction) const {
  const double h = std::hypot(direction.x(), direction.y());
  const bool at_low = h * radius_low + direction.z() * low > h * radius_high + direction.z() * high;
  const double scale = h > 0 ? (at_low ? radius_low : radius_high) / h : 0.0;
  return {scale * direction.x(), scale * direction.y(), at_low ? low : high};
}
Vec3 FrustumCore::nearest(const Vec3& p) const {
  const double r2 = p.x() * p.x() + p.y() * p.y();
  if (p.z() <= low && r2 <= radius_low * radius_low) return {p.x(), p.y(), low};
  if (p.z() >= high && r2 <= radius_high * radius_high) return {p.x(), p.y(), high};
  // Neither disc faces the point: it is inside, or its nearest is on the flank.
  const double r = std::sqrt(r2), widening = radius_high - radius_low, height = high - low;
  const double share = (p.z() - low) / height;
  if (share >= 0 && share <= 1 && r <= radius_low + widening * share) return p;
  const double t = std::clamp(
      ((r - radius_low) * widening + (p.z() - low) * height) / (widening * widening + height * height), 0.0,
      1.0);
  const double scale = r > 0 ? (radius_low + t * widening) / r : 0.0;
  return {scale * p.x(), scale * p.y(), low + t * height};
}
double FrustumCore::depth(const Vec3& p) const {
  const Vec2 section = section_of(p);
  return inside(*this, section) ? onto_outline(*this, section).distance : 0.0;
}

Vec3 BoxCore::farthest(const Vec3& direction) const {
  return (direction.array() > 0).select(half.array(), -half.array());
}
Vec3 BoxCore::nearest(const Vec3& p) const { return p.cwiseMax(-half).cwiseMin(half); }
double BoxCore::depth(const Vec3& p) const { return std::max(0.0, (half - p.cwiseAbs()).minCoeff()); }

std::optional<ConvexSolid> convex_solid(const geometry::Shape& shape) {
  struct Convert {
    std::optional<ConvexSolid> operator()(const geometry::Sphere& s) const {
      return {{PointCore{}, s.radius}};
    }
    std::optional<ConvexSolid> operator()(const geometry::Capsule& s) const {
      return {{SegmentCore{s.length / 2}, s.radius}};
    }
    std::optional<ConvexSolid> operator()(const geometry::Cylinder& s) const {
      return {{FrustumCore{s.radius, s.radius, -s.length / 2, s.length / 2}, 0}};
    }
    std::optional<ConvexSolid> operator()(const geometry::Frustum& s) const {
      return {{FrustumCore{s.radius_bottom, s.radius_top, 0, s.height}, 0}};
    }
    std::optional<ConvexSolid> operator()(const geometry::Box& s) const { return {{BoxCore{s.size / 2}, 0}}; }
    std::optional<ConvexSolid> operator()(const geometry::MeshShape&) const { return std::nullopt; }
  };
  return std::visit(Convert{}, shape.form);
}

double signed_distance(const ConvexSolid& solid, const Vec3& p) {
  return std::visit(
      [&](const auto& core) {
        const double outside = (p - core.nearest(p)).norm();
        return (outside > 0 ? outside : -core.depth(p)) - solid.radius;
      },
      solid.core);
}

namespace {

constexpr int kAround = 48;  // a rim point is missed by at most r (1 - cos(pi/48)) = 0.2 % of r

void add_ring(double radius, double z, std::vector<Ball>& balls) {
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    balls.push_back({Vec3(radius * std::cos(angle), radius * std::sin(angle), z), 0});
  }
}

void add_disc(double radius, double z, std::vector<Ball>& balls) {
  constexpr int kRings = 4;
  balls.push_back({Vec3(0, 0, z), 0});
  for (int ring = 1; ring <= kRings; ++ring) add_ring(radius * ring / kRings, z, balls);
}

struct Balls {
  double radius;
  std::vector<Ball> operator()(const PointCore&) const { return {{Vec3::Zero(), radius}}; }
  std::vector<Ball> operator()(const SegmentCore& s) const {
    constexpr double kSpacing = 1e-3;
    const int n = std::max(1, static_cast<int>(std::ceil(2 * s.half / kSpacing)));
    std::vector<Ball> balls;
    for (int i = 0; i <= n; ++i) balls.push_back({Vec3(0, 0, s.half * (2.0 * i / n - 1)), radius});
    return balls;
  }
  std::vector<Ball> operator()(const FrustumCore& f) const {
    constexpr int kLevels = 8;
    std::vector<Ball> balls;
    add_disc(f.radius_low, f.low, balls);
    add_disc(f.radius_high, f.high, balls);
    for (int i = 1; i < kLevels; ++i) {
      const double share = static_cast<double>(i) / kLevels;
      add_ring(f.radius_low + share * (f.radius_high - f.radius_low), f.low + share * (f.high - f.low),
               balls);
    }
    return balls;
  }
  std::vector<Ball> operator()(const BoxCore& b) const {
    constexpr int kSteps = 12;
    std::vector<Ball> balls;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          for (const double side : {-1.0, 1.0}) {
            Vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = 2.0 * i / kSteps - 1;
            p[(axis + 2) % 3] = 2.0 * j / kSteps - 1;
            balls.push_back({p.cwiseProduct(b.half), 0});
          }
        }
      }
    }
    return balls;
  }
};

}  // namespace

std::vector<Ball> surface_balls(const ConvexSolid& solid) {
  return std::visit(Balls{solid.radius}, solid.core);
}

double reach(const ConvexSolid& solid, const Pose& X_FS) {
  const auto farthest_corner = [&](const auto& corners) {
    double r = 0;
    for (const Vec3& p : corners) r = std::max(r, (X_FS * p).norm());
    return r;
  };
  struct Corners {
    std::vector<Vec3> operator()(const PointCore&) const { return {Vec3::Zero()}; }
    std::vector<Vec3> operator()(const SegmentCore& s) const {
      return {Vec3(0, 0, -s.half), Vec3(0, 0, s.half)};
    }
    std::vector<Vec3> operator()(const FrustumCore& f) const {
      const double r = std::max(f.radius_low, f.radius_high);  // its box: an upper bound
      return (*this)(BoxCore{Vec3(r, r, std::max(std::abs(f.low), std::abs(f.high)))});
    }
    std::vector<Vec3> operator()(const BoxCore& b) const {
      std::vector<Vec3> corners;
      for (int i = 0; i < 8; ++i) {
        corners.push_back(b.half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
      }
      return corners;
    }
  };
  return farthest_corner(std::visit(Corners{}, solid.core)) + solid.radius;
}

}  // namespace understudy::sim
