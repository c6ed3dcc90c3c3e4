#include "renderer/tessellate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <type_traits>

#include "core/units.h"

namespace understudy::renderer {
namespace {

const double kCreaseCosine = std::cos(from_deg(30));

/// One straight piece of a profile that turns about z, with the profile normals at its ends.
struct ProfilePiece {
  Vec2 from, to;                ///< (radius, z), walked so that outside is on the right
  Vec2 normal_from, normal_to;  ///< (radial, z)
};

ProfilePiece straight(const Vec2& from, const Vec2& to) {
  const Vec2 along = (to - from).normalized();
  const Vec2 normal(along.y(), -along.x());
  return {from, to, normal, normal};
}

/// A quarter of a circle.
void add_arc(std::vector<ProfilePiece>& profile, double z, double radius, double from, double to,
             int segments) {
  const int pieces = segments / 4;
  for (int i = 0; i < pieces; ++i) {
    const double a = from + (to - from) * i / pieces;
    const double b = from + (to - from) * (i + 1) / pieces;
    const Vec2 na(std::cos(a), std::sin(a)), nb(std::cos(b), std::sin(b));
    profile.push_back({Vec2(0, z) + radius * na, Vec2(0, z) + radius * nb, na, nb});
  }
}

Vec3 turn(const Vec2& rz, double angle) {
  return {rz.x() * std::cos(angle), rz.x() * std::sin(angle), rz.y()};
}

void add_triangle(Surface& s, const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals) {
  const int first = static_cast<int>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), corners.begin(), corners.end());
  s.triangles.push_back({first, first + 1, first + 2});
  s.corner_normals.push_back(normals);
}

Surface revolve(const std::vector<ProfilePiece>& profile, int segments) {
  Surface s;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const ProfilePiece& piece = profile[k];
    const bool sharp =
        k + 1 < profile.size() && piece.normal_to.dot(profile[k + 1].normal_from) < kCreaseCosine;
    for (int i = 0; i < segments; ++i) {
      const double a = 2 * std::numbers::pi * i / segments;
      const double b = 2 * std::numbers::pi * (i + 1) / segments;
      const Vec3 p00 = turn(piece.from, a), p01 = turn(piece.from, b);
      const Vec3 p10 = turn(piece.to, a), p11 = turn(piece.to, b);
      const Vec3 n00 = turn(piece.normal_from, a), n01 = turn(piece.normal_from, b);
      const Vec3 n10 = turn(piece.normal_to, a), n11 = turn(piece.normal_to, b);
      if (piece.from.x() > 0) add_triangle(s, {p00, p01, p11}, {n00, n01, n11});
      if (piece.to.x() > 0) add_triangle(s, {p00, p11, p10}, {n00, n11, n10});
      if (sharp && piece.to.x() > 0) s.creases.emplace_back(p10, p11);
    }
  }
  return s;
}

Surface surface_of(const geometry::Sphere& sphere, int segments) {
  std::vector<ProfilePiece> profile;
  add_arc(profile, 0, sphere.radius, -std::numbers::pi / 2, 0, segments);
  add_arc(profile, 0, sphere.radius, 0, std::numbers::pi / 2, segments);
  return revolve(profile, segments);
}

Surface surface_of(const geometry::Capsule& capsule, int segments) {
  const double h = capsule.length / 2, r = capsule.radius;
  std::vector<ProfilePiece> profile;
  add_arc(profile, -h, r, -std::numbers::pi / 2, 0, segments);
  if (h > 0) profile.push_back(straight({r, -h}, {r, h}));
  add_arc(profile, h, r, 0, std::numbers::pi / 2, segments);
  return revolve(profile, segments);
}

Surface surface_of(const geometry::Frustum& f, int segments) {
  std::vector<ProfilePiece> profile;
  if (f.radius_bottom > 0) profile.push_back(straight({0, 0}, {f.radius_bottom, 0}));
  profile.push_back(straight({f.radius_bottom, 0}, {f.radius_top, f.height}));
  if (f.radius_top > 0) profile.push_back(straight({f.radius_top, f.height}, {0, f.height}));
  return revolve(profile, segments);
}

Surface surface_of(const geometry::Cylinder& c, int segments) {
  Surface s = surface_of(geometry::Frustum{c.radius, c.radius, c.length}, segments);
  transform(s, make_pose(Quat::Identity(), Vec3(0, 0, -c.length / 2)));
  return s;
}

Surface surface_of(const geometry::Box& box, int) {
  Surface s;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal = Vec3::Zero(), u = Vec3::Zero(), v = Vec3::Zero();
      normal[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1;
      const auto corner = [&](double a, double b) -> Vec3 {
        return 0.5 * box.size.cwiseProduct(normal + a * u + b * v);
      };
      const Vec3 p00 = corner(-1, -1), p10 = corner(1, -1), p11 = corner(1, 1), p01 = corner(-1, 1);
      add_triangle(s, {p00, p10, p11}, {normal, normal, normal});
      add_triangle(s, {p00, p11, p01}, {normal, normal, normal});
      for (const auto& [a, b] : {std::pair{p00, p10}, {p10, p11}, {p11, p01}, {p01, p00}}) {
        if (side > 0 || axis == 0) s.creases.emplace_back(a, b);
      }
    }
  }
  return s;
}

/// A mesh keeps a vertex of a crease once for each side; the first copy stands for all of them here.
std::vector<int> joined_vertices(const std::vector<Vec3>& vertices) {
  std::map<std::array<double, 3>, int> first;
  std::vector<int> joined;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& p = vertices[i];
    joined.push_back(first.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(i)).first->second);
  }
  return joined;
}

Vec3 face_normal(const Surface& s, std::size_t triangle) {
  const auto at = [&](std::size_t k) {
    return s.vertices[static_cast<std::size_t>(s.triangles[triangle][k])];
  };
  const Vec3 scaled = (at(1) - at(0)).cross(at(2) - at(0));
  return scaled.squaredNorm() > 0 ? Vec3(scaled.normalized()) : Vec3(0, 0, 0);
}

void add_creases(Surface& s) {
  const std::vector<int> joined = joined_vertices(s.vertices);
  std::map<std::pair<int, int>, std::size_t> seen;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(s.triangles[i][k]);
      const auto b = static_cast<std::size_t>(s.triangles[i][(k + 1) % 3]);
      const auto [other, is_new] = seen.try_emplace(std::minmax(joined[a], joined[b]), i);
      if (is_new) continue;
      if (face_normal(s, i).dot(face_normal(s, other->second)) < kCreaseCosine) {
        s.creases.emplace_back(s.vertices[a], s.vertices[b]);
      }
    }
  }
}

}  // namespace

Surface tessellate(const geometry::Mesh& mesh, Creases creases) {
  Surface s;
  s.vertices = mesh.vertices();
  s.triangles = mesh.triangles();
  for (const auto& [a, b, c] : s.triangles) {
    const auto normal = [&](int v) { return mesh.vertex_normals()[static_cast<std::size_t>(v)]; };
    s.corner_normals.push_back({normal(a), normal(b), normal(c)});
  }
  if (creases == Creases::found) add_creases(s);
  return s;
}

Surface tessellate(const geometry::Shape& shape, int segments, Creases creases) {
  Surface s = std::visit(
      [&](const auto& form) {
        if constexpr (std::is_same_v<decltype(form), const geometry::MeshShape&>)
          return tessellate(*form.mesh, creases);
        else
          return surface_of(form, segments);
      },
      shape.form);
  transform(s, shape.X_FS);
  return s;
}

void transform(Surface& surface, const Pose& X_AB) {
  for (Vec3& p : surface.vertices) p = X_AB * p;
  for (auto& corners : surface.corner_normals) {
    for (Vec3& n : corners) n = X_AB.linear() * n;
  }
  for (auto& [a, b] : surface.creases) {
    a = X_AB * a;
    b = X_AB * b;
  }
}

}  // namespace understudy::renderer
