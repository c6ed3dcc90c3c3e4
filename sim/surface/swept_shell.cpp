#include "sim/surface/swept_shell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"
#include "geometry/normals.h"

namespace understudy::sim {
namespace {

constexpr double kPole = 0.02;  // of a quarter turn: a cap ends in a small ring instead of a point

struct Frame {
  Vec3 along, side, up;
};

Frame frame_at(const BeadStretch& stretch, std::size_t i) {
  const Vec3 before = i > 0 ? Vec3(stretch[i].middle_W - stretch[i - 1].middle_W) : Vec3::Zero();
  const Vec3 after =
      i + 1 < stretch.size() ? Vec3(stretch[i + 1].middle_W - stretch[i].middle_W) : Vec3::Zero();
  Frame frame;
  frame.along = (before.stableNormalized() + after.stableNormalized()).stableNormalized();
  const Vec3 side = frame.along.cross(stretch[i].up_W);
  // Laid straight along the tool axis, the section has no height direction of its own.
  frame.side = side.norm() > 1e-6 ? side.normalized() : frame.along.unitOrthogonal();
  frame.up = frame.side.cross(frame.along);
  return frame;
}

/// A ring: two half circles about the ends of the flat core, counter-clockwise seen along `along`.
void append_ring(const BeadSection& section, const Frame& frame, double latitude, int sides,
                 SweptShell& shell) {
  const double radius = 0.5 * section.height, flat = 0.5 * (section.width - section.height);
  const double across = std::cos(latitude), forward = std::sin(latitude), out = radius * across;
  const Vec3 centre = section.middle_W + radius * forward * frame.along;
  const int steps = sides / 2;
  for (const int half : {1, -1})
    for (int k = 0; k <= steps; ++k) {
      const double angle = half * std::numbers::pi * (static_cast<double>(k) / steps - 0.5);
      const double c = std::cos(angle), s = std::sin(angle);
      shell.mesh.vertices.push_back(centre + half * (flat + out * c) * frame.side +
                                    half * (half * out * s) * frame.up);
      shell.normals.push_back(across * (half * c * frame.side + s * frame.up) + forward * frame.along);
    }
}

/// The triangle by which a fan closes a ring at its corner `k`, seen from before the bead or from behind it.
std::array<int, 3> closing(int ring, int k, bool ahead) {
  return ahead ? std::array{ring, ring + k + 1, ring + k} : std::array{ring, ring + k, ring + k + 1};
}

/// A flat end at the ring that begins at vertex `ring`: with vertices of its own, for its normal is another.
void append_flat_end(int ring, int around, const Vec3& along, bool ahead, SweptShell& shell) {
  const int first = static_cast<int>(shell.mesh.vertices.size());
  for (int k = 0; k < around; ++k) {
    shell.mesh.vertices.push_back(Vec3(shell.mesh.vertices[static_cast<std::size_t>(ring + k)]));
    shell.normals.push_back(ahead ? along : Vec3(-along));
  }
  for (int k = 1; k + 1 < around; ++k) shell.mesh.triangles.push_back(closing(first, k, ahead));
}

void require_room(const BeadMesh& mesh, std::size_t vertices) {
  if (mesh.vertices.size() + vertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError("a mesh of beads has " + std::to_string(mesh.vertices.size() + vertices) +
                     " vertices, more than 2^31 - 1");
}

}  // namespace

bool is_one_bead(const BeadStretch& stretch) {
  return stretch.size() == 1 ||
         (stretch.size() == 2 && stretch[0].width == stretch[1].width &&
          stretch[0].height == stretch[1].height && stretch[0].up_W == stretch[1].up_W);
}

Bead one_bead(const BeadStretch& stretch) {
  const BeadSection &from = stretch.front(), &to = stretch.back();
  Bead bead;
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    bead.from_W[n] = static_cast<float>(from.middle_W[i]);
    bead.to_W[n] = static_cast<float>(to.middle_W[i]);
    bead.up_W[n] = static_cast<float>(from.up_W[i]);
  }
  bead.width = static_cast<float>(from.width);
  bead.height = static_cast<float>(from.height);
  return bead;
}

void append_swept(const BeadStretch& stretch, const SectionRange& range, int sides, SweptShell& shell) {
  const int first = static_cast<int>(shell.mesh.vertices.size()), around = sides + 2, quarter = sides / 4;
  const bool begins = range.first == 0, ends = range.last + 1 == stretch.size();
  const int sections = static_cast<int>(range.last - range.first) + 1;
  const int rings = sections + (begins ? quarter : 0) + (ends ? quarter : 0);
  require_room(shell.mesh, static_cast<std::size_t>(rings + 2) * static_cast<std::size_t>(around));
  const auto latitude = [&](int step) {
    return 0.5 * std::numbers::pi * std::min(static_cast<double>(step) / quarter, 1 - kPole);
  };
  const auto ring = [&](std::size_t i, double at_latitude) {
    append_ring(stretch[i], frame_at(stretch, i), at_latitude, sides, shell);
    shell.sections.resize(shell.normals.size(), i);
  };
  for (std::size_t i = range.first; i <= range.last; ++i) {
    if (i == 0)
      for (int step = quarter; step > 0; --step) ring(i, -latitude(step));
    ring(i, 0);
    if (i + 1 == stretch.size())
      for (int step = 1; step <= quarter; ++step) ring(i, latitude(step));
  }
  auto& triangles = shell.mesh.triangles;
  for (int r = 0; r + 1 < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const int a = first + r * around + k, b = first + r * around + (k + 1) % around;
      triangles.push_back({a, b + around, b});
      triangles.push_back({a, a + around, b + around});
    }
  const int last = first + (rings - 1) * around;
  for (int k = 1; k + 1 < around; ++k) {
    if (begins) triangles.push_back(closing(first, k, false));
    if (ends) triangles.push_back(closing(last, k, true));
  }
  if (!begins) append_flat_end(first, around, frame_at(stretch, range.first).along, false, shell);
  shell.sections.resize(shell.normals.size(), range.first);
  if (!ends) append_flat_end(last, around, frame_at(stretch, range.last).along, true, shell);
  shell.sections.resize(shell.normals.size(), range.last);
}

void append_whole(const BeadStretch& stretch, int sides, SweptShell& shell) {
  if (!is_one_bead(stretch)) return append_swept(stretch, {0, stretch.size() - 1}, sides, shell);
  BeadMesh one;
  append_shell(one_bead(stretch), sides, one);
  require_room(shell.mesh, one.vertices.size());
  const int first = static_cast<int>(shell.mesh.vertices.size());
  for (const Vec3& normal : geometry::vertex_pseudo_normals(one.vertices, one.triangles))
    shell.normals.push_back(normal.stableNormalized());
  const Vec3 from = stretch.front().middle_W, to = stretch.back().middle_W;
  for (const Vec3& vertex : one.vertices) {
    const bool is_nearer_the_end = (vertex - to).squaredNorm() < (vertex - from).squaredNorm();
    shell.sections.push_back(is_nearer_the_end ? stretch.size() - 1 : 0);
    shell.mesh.vertices.push_back(vertex);
  }
  for (const auto& [a, b, c] : one.triangles)
    shell.mesh.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace understudy::sim
