#include "renderer/scene_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/tessellate.h"

namespace understudy::renderer {
namespace {

constexpr int kTubeSides = 12, kSegments = 48;
constexpr double kCreaseWidth = 1.4;   // [px]
constexpr float kCreaseShade = 0.35f;  // of the shape's own colour

using Colour = std::array<float, 3>;

void put(PictureTriangles& out, const Vec3& p, const Vec3& n, const Colour& colour) {
  for (int i = 0; i < 3; ++i) out.vertices.push_back(static_cast<float>(p[i]));
  for (int i = 0; i < 3; ++i) out.vertices.push_back(static_cast<float>(n[i]));
  out.vertices.insert(out.vertices.end(), colour.begin(), colour.end());
}

std::uint32_t vertices_in(const PictureTriangles& out) {
  return static_cast<std::uint32_t>(out.vertices.size() / kVertexFloats);
}

void put_quad(PictureTriangles& out, const std::array<Vec3, 4>& p, const std::array<Vec3, 4>& n,
              const Colour& colour) {
  const std::uint32_t first = vertices_in(out);
  for (std::size_t i = 0; i < 4; ++i) put(out, p[i], n[i], colour);
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) out.corners.push_back(first + i);
}

void put_surface(PictureTriangles& out, const Surface& s, const Colour& colour) {
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      out.corners.push_back(vertices_in(out));
      put(out, s.vertices[static_cast<std::size_t>(s.triangles[t][k])], s.corner_normals[t][k], colour);
    }
  }
}

void put_surface(PictureTriangles& out, const SmoothSurface& s) {
  const std::uint32_t first = vertices_in(out);
  out.vertices.reserve(out.vertices.size() + kVertexFloats * s.vertices.size());
  out.corners.reserve(out.corners.size() + 3 * s.triangles.size());
  for (std::size_t i = 0; i < s.vertices.size(); ++i)
    put(out, s.X_WF * s.vertices[i], s.X_WF.linear() * s.normals[i], s.colour);
  for (const auto& triangle : s.triangles)
    for (const int corner : triangle) out.corners.push_back(first + static_cast<std::uint32_t>(corner));
}

/// Points of the line without repetitions, which have no direction.
std::vector<Vec3> distinct(const std::vector<Vec3>& points, double apart) {
  std::vector<Vec3> kept;
  for (const Vec3& p : points) {
    if (p.allFinite() && (kept.empty() || (p - kept.back()).norm() > apart)) kept.push_back(p);
  }
  return kept;
}

/// A tube whose cross-section is carried along without turning about the line.
void put_tube(PictureTriangles& out, const Polyline& line) {
  const auto points = distinct(line.points, 1e-3 * line.radius);
  for (const Vec3* end :
       {points.empty() ? nullptr : &points.front(), points.size() > 1 ? &points.back() : nullptr}) {
    if (!end) continue;
    const geometry::Shape ball{"", geometry::Sphere{line.radius}, make_pose(Quat::Identity(), *end)};
    put_surface(out, tessellate(ball, kTubeSides), line.colour);
  }
  if (points.size() < 2) return;
  std::array<Vec3, kTubeSides> before;
  Vec3 u = Vec3::Zero(), along_before = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& back = points[i == 0 ? 0 : i - 1];
    const Vec3& forward = points[std::min(i + 1, points.size() - 1)];
    Vec3 along = (forward - points[i]).normalized() + (points[i] - back).normalized();
    along = along.norm() > 1e-6 ? Vec3(along.normalized()) : Vec3((points[i] - back).normalized());
    u = i == 0 ? along.unitOrthogonal() : Vec3(Quat::FromTwoVectors(along_before, along) * u);
    along_before = along;
    const Vec3 v = along.cross(u);
    std::array<Vec3, kTubeSides> ring;
    for (int k = 0; k < kTubeSides; ++k) {
      const double a = 2 * std::numbers::pi * k / kTubeSides;
      ring[static_cast<std::size_t>(k)] = std::cos(a) * u + std::sin(a) * v;
    }
    for (std::size_t k = 0; i > 0 && k < kTubeSides; ++k) {
      const std::size_t next = (k + 1) % kTubeSides;
      const Vec3& a = points[i - 1];
      const Vec3& b = points[i];
      const double r = line.radius;
      put_quad(out, {a + r * before[k], a + r * before[next], b + r * ring[next], b + r * ring[k]},
               {before[k], before[next], ring[next], ring[k]}, line.colour);
    }
    before = ring;
  }
}

/// A strip of constant width on the screen, lifted a little towards the eye.
void put_crease(PictureTriangles& out, Vec3 a, Vec3 b, const Vec3& eye, double metres_per_pixel_at_1m,
                const Colour& colour) {
  const Vec3 across_a = (b - a).cross(eye - a), across_b = (b - a).cross(eye - b);
  if (across_a.norm() < 1e-12 || across_b.norm() < 1e-12) return;
  const auto half_width = [&](const Vec3& p) {
    return 0.5 * kCreaseWidth * metres_per_pixel_at_1m * (eye - p).norm();
  };
  const Vec3 da = half_width(a) * across_a.normalized(), db = half_width(b) * across_b.normalized();
  constexpr double kLift = 1e-3;
  a += kLift * (eye - a);
  b += kLift * (eye - b);
  put_quad(out, {a - da, a + da, b + db, b - db}, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()},
           colour);
}

void shift(std::vector<float>& vertices, const Vec3& by) {
  for (std::size_t i = 0; i < vertices.size(); i += kVertexFloats) {
    for (std::size_t k = 0; k < 3; ++k) vertices[i + k] -= static_cast<float>(by[static_cast<int>(k)]);
  }
}

Eigen::AlignedBox3d bounds(const std::vector<float>& vertices) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < vertices.size(); i += kVertexFloats) {
    box.extend(Vec3(static_cast<double>(vertices[i]), static_cast<double>(vertices[i + 1]),
                    static_cast<double>(vertices[i + 2])));
  }
  return box;
}

void put_ground(PictureGeometry& g, double z) {
  const double h = 4 * g.radius;
  const Colour marked{-1, 0, 0};
  const Vec3 up = Vec3::UnitZ();
  g.ground_fade = 2.2 * g.radius;
  put_quad(g.ground, {Vec3(-h, -h, z), Vec3(h, -h, z), Vec3(h, h, z), Vec3(-h, h, z)}, {up, up, up, up},
           marked);
}

// The sky is four dozen lights: a fine-grained scene, like a print of many beads, shades itself softly
// whether all of its grains are counted or one in some.
constexpr std::size_t kCastersMost = 20'000;  // triangles

/// `ends`: of each shape in the solids' corners.
std::vector<std::uint32_t> thinned_casters(const std::vector<std::uint32_t>& corners,
                                           const std::vector<std::size_t>& ends) {
  if (corners.size() <= 3 * kCastersMost) return corners;
  const std::size_t stride = corners.size() / (3 * kCastersMost) + 1;
  std::vector<std::uint32_t> casters;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    const bool fine = end - begin > 3 * kCastersMost / 4;
    for (std::size_t i = begin; i < end; i += 3 * (fine ? stride : 1))
      casters.insert(casters.end(), corners.begin() + static_cast<std::ptrdiff_t>(i),
                     corners.begin() + static_cast<std::ptrdiff_t>(i + 3));
    begin = end;
  }
  return casters;
}

}  // namespace

PictureGeometry picture_geometry(const PictureScene& scene) {
  PictureGeometry g;
  const double metres_per_pixel_at_1m = 2 * std::tan(scene.field_of_view / 2) / scene.height;
  std::vector<std::size_t> shape_ends;
  for (const ColouredShape& coloured : scene.shapes) {
    const Surface surface =
        tessellate(coloured.shape, kSegments, coloured.outlined ? Creases::found : Creases::left_out);
    put_surface(g.solids, surface, coloured.colour);
    shape_ends.push_back(g.solids.corners.size());
    if (!coloured.outlined) continue;
    Colour dark = coloured.colour;
    for (float& channel : dark) channel *= kCreaseShade;
    for (const auto& [a, b] : surface.creases)
      put_crease(g.creases, a, b, scene.eye_W, metres_per_pixel_at_1m, dark);
  }
  g.closed.begin = g.solids.corners.size();
  for (const SmoothSurface& surface : scene.surfaces) {
    put_surface(g.solids, surface);
    shape_ends.push_back(g.solids.corners.size());
  }
  g.closed.end = g.solids.corners.size();
  for (const Polyline& line : scene.polylines) put_tube(g.solids, line);
  shape_ends.push_back(g.solids.corners.size());
  if (g.solids.corners.empty()) {
    g.radius = 1;
    return g;
  }
  const Eigen::AlignedBox3d box = bounds(g.solids.vertices);
  g.centre = box.center();
  g.radius = std::max(1e-6, 0.5 * box.diagonal().norm());
  shift(g.solids.vertices, g.centre);
  g.casters = thinned_casters(g.solids.corners, shape_ends);
  shift(g.creases.vertices, g.centre);
  // Just below, so that a table that ends there does not fight with it.
  const double ground = box.min().z() - 1e-3 * g.radius;
  if (scene.eye_W.z() > ground) put_ground(g, ground - g.centre.z());
  return g;
}

std::vector<Vec3> sky_directions(int count) {
  std::vector<Vec3> directions;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count, r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return directions;
}

}  // namespace understudy::renderer
