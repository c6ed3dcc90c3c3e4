#include "renderer/tessellate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/units.h"

namespace understudy::renderer {
namespace {

constexpr int kSegments = 96;  // chord error of a 20 mm cylinder: 5 um
constexpr int kCapSegments = 16;
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

void add_arc(std::vector<ProfilePiece>& profile, double z, double radius, double from, double to) {
  for (int i = 0; i < kCapSegments; ++i) {
    const double a = from + (to - from) * i / kCapSegments;
    const double b = from + (to - from) * (i + 1) / kCapSegments;
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

Surface revolve(const std::vector<ProfilePiece>& profile) {
  Surface s;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const ProfilePiece& piece = profile[k];
    const bool sharp = k + 1 < profile.size() && piece.normal_to.dot(profile[k + 1].normal_from) < kCreaseCosine;
    for (int i = 0; i < kSegments; ++i) {
      const double a = 2 * std::numbers::pi * i / kSegments;
      const double b = 2 * std::numbers::pi * (i + 1) / kSegments;
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

Surface surface_of(const geometry::Sphere& sphere) {
  std::vector<ProfilePiece> profile;
  add_arc(profile, 0, sphere.radius, -std::numbers::pi / 2, 0);
  add_arc(profile, 0, sphere.radius, 0, std::numbers::pi / 2);
  return revolve(profile);
}

Surface surface_of(const geometry::Capsule& capsule) {
  const double h = capsule.length / 2, r = capsule.radius;
  std::vector<ProfilePiece> profile;
  add_arc(profile, -h, r, -std::numbers::pi / 2, 0);
  if (h > 0) profile.push_back(straight({r, -h}, {r, h}));
  add_arc(profile, h, r, 0, std::numbers::pi / 2);
  return revolve(profile);
}

Surface surface_of(const geometry::Frustum& f) {
  std::vector<ProfilePiece> profile;
  if (f.radius_bottom > 0) profile.push_back(straight({0, 0}, {f.radius_bottom, 0}));
  profile.push_back(straight({f.radius_bottom, 0}, {f.radius_top, f.height}));
  if (f.radius_top > 0) profile.push_back(straight({f.radius_top, f.height}, {0, f.height}));
  return revolve(profile);
}

Surface surface_of(const geometry::Cylinder& c) {
  Surface s = surface_of(geometry::Frustum{c.radius, c.radius, c.length});
  transform(s, make_pose(Quat::Identity(), Vec3(0, 0, -c.length / 2)));
  return s;
}

Surface surface_of(const geometry::Box& box) {
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

Surface surface_of(const geometry::MeshShape& shape) { return tessellate(*shape.mesh); }

Vec3 scaled_normal(const geometry::Mesh& mesh, const std::array<int, 3>& t) {
  const auto& v = mesh.vertices();
  const auto at = [&](int i) -> const Vec3& { return v[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

/// Triangles around each vertex, one after the other.
struct Fans {
  std::vector<int> first;  // of each vertex, into `triangles`
  std::vector<int> triangles;
};

Fans make_fans(const geometry::Mesh& mesh) {
  Fans fans;
  fans.first.assign(mesh.vertices().size() + 1, 0);
  for (const auto& t : mesh.triangles()) {
    for (const int v : t) ++fans.first[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 1; v < fans.first.size(); ++v) fans.first[v] += fans.first[v - 1];
  fans.triangles.resize(mesh.triangles().size() * 3);
  std::vector<int> next(fans.first.begin(), fans.first.end() - 1);
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    for (const int v : mesh.triangles()[i]) {
      fans.triangles[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(i);
    }
  }
  return fans;
}

void add_creases(Surface& s, const std::vector<Vec3>& unit_normals) {
  std::map<std::pair<int, int>, int> seen;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = s.triangles[i][k], b = s.triangles[i][(k + 1) % 3];
      const auto [other, is_new] = seen.try_emplace(std::minmax(a, b), static_cast<int>(i));
      if (is_new) continue;
      if (unit_normals[i].dot(unit_normals[static_cast<std::size_t>(other->second)]) < kCreaseCosine) {
        s.creases.emplace_back(s.vertices[static_cast<std::size_t>(a)], s.vertices[static_cast<std::size_t>(b)]);
      }
    }
  }
}

}  // namespace

Surface tessellate(const geometry::Mesh& mesh) {
  Surface s;
  s.vertices = mesh.vertices();
  s.triangles = mesh.triangles();
  s.corner_normals.resize(s.triangles.size());
  std::vector<Vec3> scaled(s.triangles.size()), unit(s.triangles.size());
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    scaled[i] = scaled_normal(mesh, s.triangles[i]);
    unit[i] = scaled[i].squaredNorm() > 0 ? Vec3(scaled[i].normalized()) : Vec3(0, 0, 0);
  }
  const Fans fans = make_fans(mesh);
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(s.triangles[i][k]);
      Vec3 sum = Vec3::Zero();
      for (int f = fans.first[v]; f < fans.first[v + 1]; ++f) {
        const auto t = static_cast<std::size_t>(fans.triangles[static_cast<std::size_t>(f)]);
        if (unit[t].dot(unit[i]) < kCreaseCosine) continue;
        // Weighted by the angle at the vertex, so that the way a face is cut into triangles does not tell.
        const auto& tri = s.triangles[t];
        const auto j = static_cast<std::size_t>(std::find(tri.begin(), tri.end(), static_cast<int>(v)) - tri.begin());
        const Vec3 a = s.vertices[static_cast<std::size_t>(tri[(j + 1) % 3])] - s.vertices[v];
        const Vec3 b = s.vertices[static_cast<std::size_t>(tri[(j + 2) % 3])] - s.vertices[v];
        sum += std::atan2(a.cross(b).norm(), a.dot(b)) * unit[t];
      }
      s.corner_normals[i][k] = sum.squaredNorm() > 0 ? Vec3(sum.normalized()) : unit[i];
    }
  }
  add_creases(s, unit);
  return s;
}

Surface tessellate(const geometry::Shape& shape) {
  Surface s = std::visit([](const auto& form) { return surface_of(form); }, shape.form);
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
