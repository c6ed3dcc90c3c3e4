#include "sim/surface/bead_slices.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::sim {
namespace {

BeadSection section(const Vec3& middle, double laid_at, double width = 0.5e-3, double height = 0.2e-3) {
  return {middle, Vec3::UnitZ(), width, height, laid_at, 1};
}

/// A spiral of one stretch that breathes, a straight bead, and a blob.
std::vector<BeadStretch> print() {
  BeadStretch spiral;
  for (int i = 0; i <= 200; ++i) {
    const double angle = 0.1 * i;
    spiral.push_back(section(Vec3(10e-3 * std::cos(angle), 10e-3 * std::sin(angle), 1e-5 * i), 5 + 0.1 * i,
                             0.5e-3 + 0.05e-3 * std::sin(0.3 * i)));
  }
  return {
      spiral, {section(Vec3(0, 0, 0), 26), section(Vec3(8e-3, 0, 0), 34)}, {section(Vec3(0, 3e-3, 0), 40)}};
}

double volume(const BeadMesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    six += at(a).cross(at(b)).dot(at(c));
  }
  return six / 6;
}

/// Edges that are not walked once in each direction. A flat end has vertices of its own, in the same places.
int open_edges(const BeadMesh& mesh) {
  std::map<std::array<double, 3>, int> numbers;
  const auto number = [&](int v) {
    const Vec3& p = mesh.vertices[static_cast<std::size_t>(v)];
    return numbers.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(numbers.size())).first->second;
  };
  std::map<std::pair<int, int>, int> walked;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = number(t[k]), b = number(t[(k + 1) % 3]);
      walked[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  int open = 0;
  for (const auto& [edge, balance] : walked) open += balance != 0;
  return open;
}

TEST(BeadSlices, EachIsClosedAndTheirVolumesAddUpToTheWhole) {
  const auto stretches = print();
  double whole = 0, sum = 0;
  for (std::size_t s : {0u, 2u}) {  // the straight bead's ends are of another form where it is cut
    BeadMesh mesh;
    append_sweep(stretches[s], sides_within(stretches[s], 3e-6), mesh);
    whole += volume(mesh);
  }
  for (const BeadSlice& slice : slice_beads({stretches[0], stretches[2]}, {37, 3e-6})) {
    EXPECT_EQ(open_edges(slice.mesh), 0) << slice.by;
    EXPECT_GT(volume(slice.mesh), 0) << slice.by;
    sum += volume(slice.mesh);
  }
  // A new section at a cut bends the mitre at its neighbours by nothing, but a section that breathes has its
  // corners on another straight line: a tenth of a per mille.
  EXPECT_NEAR(sum, whole, 1e-4 * whole);
}

TEST(BeadSlices, ASliceHoldsWhatWasLaidInItsTime) {
  const auto slices = slice_beads(print(), {70, 3e-6});  // 5 to 40 s: half a second each
  double before = 0;
  for (const BeadSlice& slice : slices) {
    EXPECT_NEAR(slice.by, 5 + 0.5 * std::round((slice.by - 5) / 0.5), 1e-9);
    EXPECT_GT(slice.by, before);
    before = slice.by;
    ASSERT_EQ(slice.where.size(), slice.mesh.vertices.size());
    for (const BeadSection& where : slice.where) {
      EXPECT_LE(where.laid_at, slice.by + 1e-9);
      EXPECT_GE(where.laid_at, slice.by - 0.5 - 1e-9);
    }
  }
  // 40 of the spiral, 16 of the straight bead and one of the blob; what began at 5 s is with the first.
  EXPECT_EQ(slices.size(), 57u);
}

TEST(BeadSlices, TheStraightBeadGrowsWithTime) {
  const auto slices = slice_beads(print(), {70, 3e-6});
  for (const BeadSlice& slice : slices) {
    if (slice.by < 26.4 || slice.by > 34.1) continue;
    double farthest = 0;
    for (const Vec3& vertex : slice.mesh.vertices) farthest = std::max(farthest, vertex.x());
    const double end = slice.by > 33.9 ? 0.1e-3 : 0;  // the round end
    EXPECT_NEAR(farthest, 1e-3 * (slice.by - 26) + end, 1e-6) << slice.by;
  }
}

TEST(BeadSlices, NormalsPointOutwardsAndVerticesKnowTheirSection) {
  for (const BeadSlice& slice : slice_beads(print(), {11, 3e-6})) {
    ASSERT_EQ(slice.normals.size(), slice.mesh.vertices.size());
    for (std::size_t v = 0; v < slice.normals.size(); ++v) {
      EXPECT_NEAR(slice.normals[v].norm(), 1, 1e-9);
      const BeadSection& where = slice.where[v];
      EXPECT_LE((slice.mesh.vertices[v] - where.middle_W).norm(), 0.5 * where.width + 1e-9);
    }
    for (const auto& t : slice.mesh.triangles) {
      const auto at = [&](std::size_t k) { return slice.mesh.vertices[static_cast<std::size_t>(t[k])]; };
      const Vec3 face = (at(1) - at(0)).cross(at(2) - at(0));
      for (const int v : t) EXPECT_GE(face.dot(slice.normals[static_cast<std::size_t>(v)]), -1e-15);
    }
  }
}

TEST(BeadSlices, NoSlicesAreRefused) {
  EXPECT_THROW(slice_beads(print(), {0, 3e-6}), InputError);
  EXPECT_TRUE(slice_beads({}, {10, 3e-6}).empty());
}

}  // namespace
}  // namespace understudy::sim
