#include "sim/surface/as_printed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class AsPrinted : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
};

// A stretch along x, its middle at this height.
Bead bead_at(float y, float z) {
  Bead bead;
  bead.from_W = {-5e-3f, y, z};
  bead.to_W = {5e-3f, y, z};
  bead.width = 0.6e-3f;
  bead.height = 0.2e-3f;
  return bead;
}

std::shared_ptr<const geometry::Mesh> box(const Vec3& low, const Vec3& high) {
  const geometry::Triangles t = geometry::box(low, high);
  return std::make_shared<const geometry::Mesh>(t.vertices, t.triangles);
}

template <typename Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value;
  std::memcpy(&value, bytes.data() + at, sizeof(Number));
  return value;
}

std::size_t body_of(const std::string& ply) { return ply.find("end_header\n") + 11; }

TEST_F(AsPrinted, StlReadsBackAsTheSameSolid) {
  BeadIndex beads;
  const std::vector<Bead> laid{bead_at(0, 1e-3f), bead_at(2e-3f, 1e-3f)};
  for (const Bead& bead : laid) beads.add(bead);
  const AsPrintedSize size = write_as_printed(folder_ / "part.stl", beads);
  EXPECT_EQ(size.beads, 2u);
  EXPECT_EQ(fs::file_size(folder_ / "part.stl"), 84 + 50 * size.triangles);
  const auto read = geometry::read_stl(folder_ / "part.stl");
  const BeadMesh mesh = bead_mesh(laid);
  const double volume = geometry::Mesh(mesh.vertices, mesh.triangles).volume();
  // Corners of a file in single precision: 1e-7 of 5 mm on 0.2 mm.
  EXPECT_NEAR(read->volume(), volume, 1e-5 * volume);
  EXPECT_NEAR(read->upper().z(), 1.1e-3, 1e-9);
}

TEST_F(AsPrinted, PlyTellsTheDeviationOfEveryVertex) {
  BeadIndex beads;
  beads.add(bead_at(0, 1e-3f));
  const auto intended = box(Vec3(-20e-3, -20e-3, -20e-3), Vec3(20e-3, 20e-3, 1.05e-3));
  AsPrintedSettings settings;
  settings.intended = intended.get();
  settings.limit = 0.1e-3;
  const AsPrintedSize size = write_as_printed(folder_ / "part.ply", beads, settings);
  const std::string ply = read_file(folder_ / "part.ply");
  EXPECT_THAT(ply, HasSubstr("format binary_little_endian 1.0\n"));
  EXPECT_THAT(ply, HasSubstr("blue -0.100000 mm, white 0, red +0.100000 mm"));
  EXPECT_THAT(ply, HasSubstr("element vertex " + std::to_string(size.vertices) + "\n"));
  EXPECT_THAT(ply, HasSubstr("element face " + std::to_string(size.triangles) + "\n"));
  const std::size_t body = body_of(ply);
  ASSERT_EQ(ply.size(), body + 19 * size.vertices + 13 * size.triangles);
  for (std::size_t v = 0; v < size.vertices; ++v) {
    const std::size_t at = body + 19 * v;
    const double z = number_at<float>(ply, at + 8), deviation = number_at<float>(ply, at + 12);
    ASSERT_NEAR(deviation, z - 1.05, 1e-6);  // mm, in single precision; the top face is the nearest
    const auto colour = deviation_colour(from_mm(deviation), settings.limit);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(number_at<std::uint8_t>(ply, at + 16 + c), colour[c]);
  }
  for (std::size_t t = 0; t < size.triangles; ++t) {
    const std::size_t at = body + 19 * size.vertices + 13 * t;
    ASSERT_EQ(number_at<std::uint8_t>(ply, at), 3);
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_LT(static_cast<std::size_t>(number_at<std::int32_t>(ply, at + 1 + 4 * k)), size.vertices);
  }
}

TEST_F(AsPrinted, FacesGoOnCountingAcrossChunks) {
  BeadIndex beads;
  constexpr int kBeads = 20000;  // more than two chunks
  for (int i = 0; i < kBeads; ++i) {
    const int column = i % 100;
    const int row = i / 100;
    Bead bead;
    bead.from_W = bead.to_W = {static_cast<float>(column) * 1e-3f, static_cast<float>(row) * 1e-3f, 1e-3f};
    bead.width = bead.height = 0.4e-3f;
    beads.add(bead);
  }
  AsPrintedSettings settings;
  settings.sides = 4;
  const AsPrintedSize size = write_as_printed(folder_ / "part.ply", beads, settings);
  EXPECT_EQ(size.vertices, 6u * kBeads);  // octahedra
  EXPECT_EQ(size.triangles, 8u * kBeads);
  const std::string ply = read_file(folder_ / "part.ply");
  const std::size_t faces = body_of(ply) + 12 * size.vertices;
  for (std::size_t t = 0; t < size.triangles; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(static_cast<std::size_t>(number_at<std::int32_t>(ply, faces + 13 * t + 1 + 4 * k)) / 6,
                t / 8);
}

TEST_F(AsPrinted, TheBytesDoNotDependOnTheThreads) {
  BeadIndex beads;
  for (int i = 0; i < 50; ++i) beads.add(bead_at(static_cast<float>(i) * 0.3e-3f, 1e-3f));
  const auto intended = box(Vec3(-5e-3, -5e-3, 0), Vec3(5e-3, 5e-3, 1e-3));
  AsPrintedSettings settings;
  settings.intended = intended.get();
  settings.skin = 0.1e-3;
  settings.threads = 1;
  write_as_printed(folder_ / "one.ply", beads, settings);
  settings.threads = 7;
  write_as_printed(folder_ / "seven.ply", beads, settings);
  EXPECT_EQ(read_file(folder_ / "one.ply"), read_file(folder_ / "seven.ply"));
}

TEST_F(AsPrinted, ASkinLeavesOutWhatIsBuried) {
  BeadIndex beads;
  for (const float z : {-6e-3f, -1e-3f, 1e-3f}) beads.add(bead_at(0, z));
  const auto intended = box(Vec3(-20e-3, -20e-3, -20e-3), Vec3(20e-3, 20e-3, 1e-3));
  AsPrintedSettings settings;
  settings.intended = intended.get();
  EXPECT_EQ(write_as_printed(folder_ / "all.stl", beads, settings).beads, 3u);
  // A bead reaches 5.4 mm about its middle: the lowest stays wholly more than 1 mm below the top, 7 mm deep.
  settings.skin = 1e-3;
  EXPECT_EQ(write_as_printed(folder_ / "skin.stl", beads, settings).beads, 2u);
  EXPECT_NEAR(geometry::read_stl(folder_ / "skin.stl")->lower().z(), -1.1e-3, 1e-9);
}

TEST_F(AsPrinted, ColoursRunFromBlueOverWhiteToRedAndStop) {
  const std::array<std::uint8_t, 3> blue{33, 102, 172}, white{247, 247, 247}, red{178, 24, 43};
  EXPECT_EQ(deviation_colour(0, 1e-4), white);
  EXPECT_EQ(deviation_colour(-1e-4, 1e-4), blue);
  EXPECT_EQ(deviation_colour(1e-4, 1e-4), red);
  EXPECT_EQ(deviation_colour(-1, 1e-4), blue);
  EXPECT_EQ(deviation_colour(1, 1e-4), red);
  EXPECT_EQ(deviation_colour(0.5e-4, 1e-4)[1], 136);  // half way from 247 to 24, rounded
}

TEST_F(AsPrinted, RefusesWhatCannotBeWritten) {
  BeadIndex beads;
  EXPECT_THROW(write_as_printed(folder_ / "part.stl", beads), InputError);
  beads.add(bead_at(0, 1e-3f));
  EXPECT_THROW(write_as_printed(folder_ / "part.obj", beads), InputError);
  AsPrintedSettings settings;
  settings.skin = 1e-3;  // without a part
  EXPECT_THROW(write_as_printed(folder_ / "part.stl", beads, settings), InputError);
  settings.skin.reset();
  settings.limit = 0;
  EXPECT_THROW(write_as_printed(folder_ / "part.ply", beads, settings), InputError);
  fs::create_directories(folder_ / "taken.stl" / "inside");
  EXPECT_THROW(write_as_printed(folder_ / "taken.stl", beads), MachineError);
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    left.push_back(entry.path().filename().string());
  EXPECT_THAT(left, ::testing::ElementsAre("taken.stl"));
}

}  // namespace
}  // namespace understudy::sim
