#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>

#include <unistd.h>

#include "core/output_file.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy {
namespace {

const std::filesystem::path kParts = UNDERSTUDY_SOURCE_DIR "/models/parts";

TEST(Parts, MakingThemAgainGivesTheSameBytes) {
  const auto folder =
      std::filesystem::path(::testing::TempDir()) / ("understudy_parts_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  ASSERT_EQ(std::system(("\"" MAKE_PARTS "\" \"" + folder.string() + "\"").c_str()), 0);
  for (const char* name : {"bottle.stl", "slanted_box.stl"})
    EXPECT_TRUE(read_file(folder / name) == read_file(kParts / name)) << name;
  std::filesystem::remove_all(folder);
}

TEST(Parts, MakePartsRefusesAFolderThatIsNotThere) {
  const int status = std::system("\"" MAKE_PARTS "\" /nonexistent/folder 2> /dev/null");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

TEST(Parts, TheBottleIsClosedLiesOnTheTableAndMeasures31Millimetres) {
  const auto bottle = geometry::read_stl(kParts / "bottle.stl");
  EXPECT_EQ(bottle->open_edges(), 0);
  EXPECT_GT(bottle->volume(), 0);
  EXPECT_EQ(bottle->lower().z(), 0);
  EXPECT_DOUBLE_EQ(to_mm(bottle->upper().z()), 31);
  EXPECT_DOUBLE_EQ(to_mm(bottle->upper().x() - bottle->lower().x()), 31);
  EXPECT_DOUBLE_EQ(to_mm(bottle->lower().y()), -35);
}

TEST(Parts, TheBottlesBodyIsRoundToTheSagOfItsFacets) {
  const auto bottle = geometry::read_stl(kParts / "bottle.stl");
  const double sag = 15.5e-3 * (1 - std::cos(std::numbers::pi / 360));  // 0.6 um
  const Vec3 axis(0, 0, 15.5e-3);
  for (double y = -0.0324; y < 0.0344; y += 0.00371) {
    for (double a = 0.1; a < 360; a += 0.73) {
      const Vec3 radial(std::cos(a * kDegree), 0, std::sin(a * kDegree));
      const auto hit = bottle->ray_hit(axis + y * Vec3::UnitY(), radial, 1);
      ASSERT_TRUE(hit);
      ASSERT_LE(hit->distance, 15.5e-3 + 1e-9);  // the STL's single precision
      ASSERT_GE(hit->distance, 15.5e-3 - sag - 1e-9);
      ASSERT_LT(std::acos(std::min(1.0, hit->normal.dot(radial))), 0.001 * kDegree);
    }
  }
}

TEST(Parts, TheSlantedBoxHasItsTopAtFifteenDegrees) {
  const auto box = geometry::read_stl(kParts / "slanted_box.stl");
  EXPECT_EQ(box->lower().z(), 0);
  const auto top = box->ray_hit(Vec3(0.003, -0.002, 0.1), -Vec3::UnitZ(), 1);
  ASSERT_TRUE(top);
  EXPECT_NEAR(to_deg(std::acos(top->normal.z())), 15, 1e-4);
  EXPECT_GT(top->normal.x(), 0);
  EXPECT_NEAR(top->position.z(), 18e-3 - 3e-3 * std::tan(15 * kDegree), 1e-8);
}

}  // namespace
}  // namespace understudy
