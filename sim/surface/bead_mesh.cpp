#include "sim/surface/bead_mesh.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"
#include "sim/beads/bead_shape.h"

namespace understudy::sim {
namespace {

// Of the height: a flat narrower than this is thinner than the numbers of a file can show.
constexpr double kNoFlat = 1e-4;

void require_sides(int sides) {
  if (sides < 4 || sides > kBeadSidesMax || sides % 4 != 0)
    throw InputError("a bead of " + std::to_string(sides) + " sides: a multiple of 4 from 4 to " +
                     std::to_string(kBeadSidesMax) + " is needed");
}

// The bead is its flat core, rolled around by a ball. Seen along `up`, the core's outline turns once around:
// a direction for every side, and at a corner both of its sides' directions.
struct Rim {
  Vec3 corner, outward;
  int cap;  // which corner
};

struct Outline {
  std::vector<Rim> rims;
  Vec3 up{0, 0, 1};
  double radius = 0;
  int caps = 0;
};

/// Sides of the outline, of `sides` around, that turn about one corner.
struct CornerSides {
  int first, last, sides;
};

void add_corner(Outline& outline, const Vec3& corner, const Vec3& x, const Vec3& y, const CornerSides& of) {
  for (int i = of.first; i <= of.last; ++i) {
    const double angle = 2 * std::numbers::pi * i / of.sides;
    outline.rims.push_back({corner, std::cos(angle) * x + std::sin(angle) * y, outline.caps});
  }
  ++outline.caps;
}

bool is_round(const Bead& bead) {
  return static_cast<double>(bead.width) - static_cast<double>(bead.height) <=
         kNoFlat * static_cast<double>(bead.height);
}

Outline outline_of(const Bead& bead, int sides) {
  const BeadCore core = core_of(bead);
  const bool round = is_round(bead);
  const int quarter = sides / 4;
  Outline outline;
  outline.up = core.up;
  outline.radius = core.radius;
  const double half_length = core.half_along.norm();
  if (half_length == 0) {
    const Vec3 x = core.up.unitOrthogonal(), y = core.up.cross(x);
    if (round) {
      add_corner(outline, core.middle, x, y, {0, sides - 1, sides});
      return outline;
    }
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      const Vec3 outward = std::cos(angle) * x + std::sin(angle) * y;
      add_corner(outline, core.middle + core.disc_radius * outward, x, y, {i, i, sides});
    }
    return outline;
  }
  const Vec3 x = core.half_along / half_length, y = core.up.cross(x);
  const Vec3 ahead = core.middle + core.half_along, behind = core.middle - core.half_along;
  if (round) {
    add_corner(outline, ahead, x, y, {-quarter, quarter, sides});
    add_corner(outline, behind, x, y, {quarter, 3 * quarter, sides});
    return outline;
  }
  const Vec3 side = core.half_side.norm() * y;
  add_corner(outline, ahead + side, x, y, {0, quarter, sides});
  add_corner(outline, behind + side, x, y, {quarter, 2 * quarter, sides});
  add_corner(outline, behind - side, x, y, {2 * quarter, 3 * quarter, sides});
  add_corner(outline, ahead - side, x, y, {3 * quarter, sides, sides});
  return outline;
}

struct Turn {
  int rims, caps;
};

Turn turn_of(const Bead& bead, int sides) {
  const bool round = is_round(bead);
  if (bead.from_W == bead.to_W) return {sides, round ? 1 : sides};
  return round ? Turn{sides + 2, 2} : Turn{sides + 4, 4};
}

// Vertex numbers of a shell: the lower caps, rings from below to above, the upper caps.
class Numbering {
 public:
  Numbering(int first, const Outline& outline, int bands)
      : first_(first), rims_(static_cast<int>(outline.rims.size())), bands_(bands), outline_(outline) {}

  int at(int ring, int rim) const {
    const int cap = outline_.rims[static_cast<std::size_t>(rim)].cap;
    if (ring == 0) return lower(cap);
    return ring == bands_ ? upper(cap) : first_ + outline_.caps + (ring - 1) * rims_ + rim;
  }
  int lower(int cap) const { return first_ + cap; }
  int upper(int cap) const { return first_ + outline_.caps + (bands_ - 1) * rims_ + cap; }

 private:
  int first_, rims_, bands_;
  const Outline& outline_;
};

void append_vertices(const Outline& outline, int bands, std::vector<Vec3>& vertices) {
  const Vec3 top = outline.radius * outline.up;
  const auto append_caps = [&](const Vec3& offset) {
    int next = 0;
    for (const Rim& rim : outline.rims) {
      if (rim.cap != next) continue;
      vertices.push_back(rim.corner + offset);
      ++next;
    }
  };
  append_caps(-top);
  for (int ring = 1; ring < bands; ++ring) {
    const double latitude = std::numbers::pi * (static_cast<double>(ring) / bands - 0.5);
    const double out = outline.radius * std::cos(latitude);
    const Vec3 height = std::sin(latitude) * top;
    for (const Rim& rim : outline.rims) vertices.push_back(rim.corner + out * rim.outward + height);
  }
  append_caps(top);
}

}  // namespace

void append_shell(const Bead& bead, int sides, BeadMesh& mesh) {
  const ShellSize size = shell_size(bead, sides);
  if (mesh.vertices.size() + size.vertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError("a mesh of beads has " + std::to_string(mesh.vertices.size() + size.vertices) +
                     " vertices, more than 2^31 - 1");
  const Outline outline = outline_of(bead, sides);
  const int bands = sides / 2, rims = static_cast<int>(outline.rims.size());
  const Numbering number(static_cast<int>(mesh.vertices.size()), outline, bands);
  append_vertices(outline, bands, mesh.vertices);

  auto& triangles = mesh.triangles;
  for (int ring = 0; ring < bands; ++ring) {
    for (int rim = 0; rim < rims; ++rim) {
      const int next = (rim + 1) % rims;
      const int a = number.at(ring, rim), b = number.at(ring, next);
      const int c = number.at(ring + 1, next), d = number.at(ring + 1, rim);
      if (a != b) triangles.push_back({a, b, c});
      if (c != d) triangles.push_back({a, c, d});
    }
  }
  for (int cap = 2; cap < outline.caps; ++cap) {
    triangles.push_back({number.lower(0), number.lower(cap), number.lower(cap - 1)});
    triangles.push_back({number.upper(0), number.upper(cap - 1), number.upper(cap)});
  }
}

BeadMesh bead_mesh(std::span<const Bead> beads, int sides) {
  BeadMesh mesh;
  ShellSize size;
  for (const Bead& bead : beads) {
    const ShellSize one = shell_size(bead, sides);
    size.vertices += one.vertices;
    size.triangles += one.triangles;
  }
  mesh.vertices.reserve(size.vertices);
  mesh.triangles.reserve(size.triangles);
  for (const Bead& bead : beads) append_shell(bead, sides, mesh);
  return mesh;
}

double chord_error(const Bead& bead, int sides) {
  require_sides(sides);
  const double step = 2 * std::numbers::pi / sides;
  // A face spans one step in both angles: its corners are half the diagonal away from its middle.
  const double ball = 0.5 * static_cast<double>(bead.height) * (1 - std::cos(step / std::numbers::sqrt2));
  if (bead.from_W != bead.to_W) return ball;
  const double disc = 0.5 * (static_cast<double>(bead.width) - static_cast<double>(bead.height));
  return ball + disc * (1 - std::cos(step / 2));
}

ShellSize shell_size(const Bead& bead, int sides) {
  require_sides(sides);
  const Turn turn = turn_of(bead, sides);
  const auto rims = static_cast<std::size_t>(turn.rims), caps = static_cast<std::size_t>(turn.caps);
  const auto bands = static_cast<std::size_t>(sides / 2);
  ShellSize size;
  size.vertices = 2 * caps + (bands - 1) * rims;
  size.triangles = 2 * size.vertices - 4;  // Euler, for a closed shell without handles
  return size;
}

}  // namespace understudy::sim
