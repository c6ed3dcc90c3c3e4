// Solids with a closed form, as triangles.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/frames.h"
#include "geometry/box_mesh.h"

namespace understudy::geometry {

struct Triangles {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Box from `lower` to `upper`.
inline Triangles box(const Vec3& lower, const Vec3& upper) {
  return {box_corners(lower, upper), box_triangles()};
}

/// Boxes, each from a lower to an upper corner, beside or in each other.
inline Triangles boxes(const std::vector<std::pair<Vec3, Vec3>>& corners) {
  Triangles all;
  for (const auto& [lower, upper] : corners) {
    const int first = static_cast<int>(all.vertices.size());
    const Triangles one = box(lower, upper);
    all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const auto& [a, b, c] : one.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

/// Surface of revolution about z through (z, r) pairs; the first and the last must have r = 0.
inline Triangles revolve(const std::vector<std::array<double, 2>>& profile, int facets) {
  Triangles t;
  std::vector<int> ring_start;
  for (const auto& [z, r] : profile) {
    ring_start.push_back(static_cast<int>(t.vertices.size()));
    for (int k = 0; k < (r > 0 ? facets : 1); ++k) {
      const double phi = 2 * std::numbers::pi * k / facets;
      t.vertices.push_back(Vec3(r * std::cos(phi), r * std::sin(phi), z));
    }
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const bool low_pole = !(profile[i][1] > 0), high_pole = !(profile[i + 1][1] > 0);
    for (int k = 0; k < facets; ++k) {
      const int next = (k + 1) % facets;
      const int a = ring_start[i] + (low_pole ? 0 : k), b = ring_start[i] + (low_pole ? 0 : next);
      const int c = ring_start[i + 1] + (high_pole ? 0 : next), d = ring_start[i + 1] + (high_pole ? 0 : k);
      if (!low_pole) t.triangles.push_back({a, b, c});
      if (!high_pole) t.triangles.push_back({a, c, d});
    }
  }
  return t;
}

inline Triangles sphere(double radius, int rings, int facets) {
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= rings; ++i) {
    const double polar = std::numbers::pi * i / rings;
    const bool pole = i == 0 || i == rings;
    profile.push_back({-radius * std::cos(polar), pole ? 0 : radius * std::sin(polar)});
  }
  return revolve(profile, facets);
}

/// Cylinder about z from -length/2 to length/2 with flat caps.
inline Triangles cylinder(double radius, double length, int facets) {
  return revolve({{-length / 2, 0}, {-length / 2, radius}, {length / 2, radius}, {length / 2, 0}}, facets);
}

}  // namespace understudy::geometry
