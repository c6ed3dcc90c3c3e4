#include "sim/surface/bead_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random_vector.h"
#include "geometry/mesh.h"
#include "sim/beads/bead_shape.h"

namespace understudy::sim {
namespace {

// Coordinates of some 0.1 m in doubles, after a few rotations.
constexpr double kRounding = 1e-14;

std::array<float, 3> narrow(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Bead bead_between(const Vec3& from, const Vec3& to, const Vec3& up, double width, double height) {
  Bead bead;
  bead.from_W = narrow(from);
  bead.to_W = narrow(to);
  bead.up_W = narrow(up.normalized());
  bead.width = static_cast<float>(width);
  bead.height = static_cast<float>(height);
  return bead;
}

Vec3 any_direction(Random& random) { return normal_vec3(random).normalized(); }

// Every kind in every posture: flat or round, long or a blob, the normal askew or along the path.
Bead any_bead(Random& random, int kind) {
  const Vec3 from = 0.1 * any_direction(random), along = any_direction(random);
  const double height = random.uniform(0.1e-3, 1e-3);
  const double width = kind % 2 ? height : height * random.uniform(1.2, 5);
  const double length = kind / 2 % 2 ? 0 : random.uniform(0.05e-3, 20e-3);
  const Vec3 up = kind / 4 % 2 ? along : any_direction(random);
  return bead_between(from, from + length * along, up, width, height);
}

double volume(const BeadMesh& mesh) { return geometry::Mesh(mesh.vertices, mesh.triangles).volume(); }

TEST(BeadMesh, EveryShellIsClosedWithItsOutsideOut) {
  Random random(7, "bead mesh test");
  for (int i = 0; i < 800; ++i) {
    const Bead bead = any_bead(random, i);
    const int sides = 4 << i / 8 % 4;
    const BeadMesh shell = bead_mesh({&bead, 1}, sides);
    const geometry::Mesh mesh(shell.vertices, shell.triangles);
    EXPECT_EQ(mesh.open_edges(), 0) << i;
    EXPECT_EQ(mesh.flipped_edges(), 0) << i;
    EXPECT_GT(mesh.volume(), 0) << i;
    // Euler: V - E + F = 2 with three half edges a face.
    EXPECT_EQ(2 * shell.vertices.size(), 4 + shell.triangles.size()) << i;
  }
}

TEST(BeadMesh, VerticesLieOnTheBeadAndFacesWithinTheChordError) {
  Random random(8, "bead mesh test");
  for (int i = 0; i < 800; ++i) {
    const Bead bead = any_bead(random, i);
    const BeadCore core = core_of(bead);
    const int sides = 4 << i / 8 % 4;
    const BeadMesh shell = bead_mesh({&bead, 1}, sides);
    for (const Vec3& vertex : shell.vertices) ASSERT_NEAR(signed_distance(core, vertex), 0, kRounding) << i;
    for (const auto& t : shell.triangles) {
      const Vec3 middle =
          (shell.vertices[static_cast<std::size_t>(t[0])] + shell.vertices[static_cast<std::size_t>(t[1])] +
           shell.vertices[static_cast<std::size_t>(t[2])]) /
          3;
      ASSERT_LE(signed_distance(core, middle), kRounding) << i;
      ASSERT_GE(signed_distance(core, middle), -chord_error(bead, sides) - kRounding) << i;
    }
  }
}

// The flat core a x b rolled around by a ball: a slab, half a prism along each edge and a ball at the
// corners, the prism with `sides` corners and the ball with as many along each circle.
double polyhedron(double a, double b, double r, int sides) {
  const double polygon = 0.5 * sides * std::sin(2 * std::numbers::pi / sides);
  double ball = 0;
  for (int band = 0; band < sides / 2; ++band) {
    const double low = 2 * std::numbers::pi * band / sides, high = 2 * std::numbers::pi * (band + 1) / sides;
    const double p = polygon * std::pow(std::sin(low), 2), q = polygon * std::pow(std::sin(high), 2);
    ball += (std::cos(low) - std::cos(high)) / 3 * (p + q + std::sqrt(p * q));
  }
  return 2 * r * a * b + polygon * r * r * (a + b) + ball * r * r * r;
}

TEST(BeadMesh, VolumeIsThatOfTheRolledRectangle) {
  Random random(9, "bead mesh test");
  for (int i = 0; i < 400; ++i) {
    const Bead bead = any_bead(random, i % 2 + 4 * (i / 2 % 2));
    const BeadCore core = core_of(bead);
    const int sides = 4 << i / 8 % 4;
    const double expected =
        polyhedron(2 * core.half_along.norm(), 2 * core.half_side.norm(), core.radius, sides);
    // Tetrahedra of doubles about the mesh's middle.
    EXPECT_NEAR(volume(bead_mesh({&bead, 1}, sides)), expected, 1e-9 * expected) << i;
  }
}

TEST(BeadMesh, VolumeTendsToTheStadiumsWithTheSides) {
  const Bead bead = bead_between({0, 0, 0}, {0.01, 0, 0}, {0, 0, 1}, 0.5e-3, 0.2e-3);
  const double r = 0.1e-3, a = 0.01, b = 0.3e-3;
  const double pi = std::numbers::pi;
  const double exact = 2 * r * a * b + pi * r * r * (a + b) + 4 * pi / 3 * r * r * r;
  double before = exact;
  for (const int sides : {8, 16, 32, 64}) {
    const double lost = exact - volume(bead_mesh({&bead, 1}, sides));
    EXPECT_GT(lost, 0);
    EXPECT_LT(lost, before / (sides == 8 ? 1 : 3.8));  // chords: fourfold fewer with twice the sides
    before = lost;
  }
  EXPECT_LT(before, 1e-3 * exact);
}

TEST(BeadMesh, ABlobIsAFlatDiscRolledAround) {
  const Bead flat = bead_between({0, 0, 0.01}, {0, 0, 0.01}, {0, 1, 1}, 1e-3, 0.4e-3);
  const double r = 0.2e-3, disc = 0.3e-3, pi = std::numbers::pi;
  const double exact = 2 * pi * disc * disc * r + pi * pi * r * r * disc + 4 * pi / 3 * r * r * r;
  // A polygon's share of its circle at 256 sides, in two directions: 1 - (2 pi / 256)^2 / 6 each.
  EXPECT_NEAR(volume(bead_mesh({&flat, 1}, 256)), exact, 2.5e-4 * exact);
}

TEST(BeadMesh, AStrutAlongTheToolAxisKeepsItsSection) {
  const Bead strut = bead_between({0, 0, 0}, {0, 0, 0.005}, {0, 0, 1}, 0.6e-3, 0.4e-3);
  const BeadMesh shell = bead_mesh({&strut, 1}, 16);
  double widest = 0, narrowest = 1;
  for (int i = 0; i < 180; ++i) {
    const Vec3 across(std::cos(i * std::numbers::pi / 180), std::sin(i * std::numbers::pi / 180), 0);
    double low = 1, high = -1;
    for (const Vec3& v : shell.vertices) {
      low = std::min(low, v.dot(across));
      high = std::max(high, v.dot(across));
    }
    widest = std::max(widest, high - low);
    narrowest = std::min(narrowest, high - low);
  }
  EXPECT_NEAR(widest, 0.6e-3, 1e-10);     // float coordinates
  EXPECT_NEAR(narrowest, 0.4e-3, 1e-10);  // where the flat sides face
}

TEST(BeadMesh, SizeIsKnownBefore) {
  Random random(10, "bead mesh test");
  BeadMesh mesh;
  ShellSize size;
  for (int i = 0; i < 64; ++i) {
    const Bead bead = any_bead(random, i);
    append_shell(bead, 12, mesh);
    size.vertices += shell_size(bead, 12).vertices;
    size.triangles += shell_size(bead, 12).triangles;
    EXPECT_EQ(mesh.vertices.size(), size.vertices);
    EXPECT_EQ(mesh.triangles.size(), size.triangles);
  }
}

TEST(BeadMesh, RefusesSidesThatAreNoMultipleOfFour) {
  const Bead bead = bead_between({0, 0, 0}, {0.01, 0, 0}, {0, 0, 1}, 0.5e-3, 0.2e-3);
  for (const int sides : {-4, 0, 2, 6, 13, 260}) EXPECT_THROW(bead_mesh({&bead, 1}, sides), InputError);
}

}  // namespace
}  // namespace understudy::sim
