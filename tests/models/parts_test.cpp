#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <tuple>

#include "core/file/read_file.h"
#include "core/units.h"
#include "geometry/mesh.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {

const std::filesystem::path kParts = UNDERSTUDY_SOURCE_DIR "/models/parts";

TEST(Parts, MakingThemAgainGivesTheSameBytes) {
  const TemporaryFolder folder;
  ASSERT_EQ(std::system(("\"" MAKE_PARTS "\" \"" + folder.path().string() + "\"").c_str()), 0);
  for (const char* name :
       {"bottle.stl", "slanted_box.stl", "crown.stl", "crown_core.stl", "crown_base.stl", "bent_cylinder.stl",
        "bent_bar.stl", "s_tube.stl", "cross_90.stl", "cross_150.stl", "ellipse_50.stl", "ellipse_75.stl",
        "column_with_arms.stl", "two_bends_round.stl", "two_bends_bar.stl", "two_bends_oval.stl"})
    EXPECT_TRUE(read_file(folder / name) == read_file(kParts / name)) << name;
}

TEST(Parts, MakePartsRefusesAFolderThatIsNotThere) {
  const int status = std::system("\"" MAKE_PARTS "\" /nonexistent/folder 2> /dev/null");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

/// Pappus: a section's area times the length of its middle's way; facets take up to 0.4 % of a circle and of
/// a bend.
TEST(Parts, TheBentPartsAreClosedAndHoldTheirSectionTimesTheirAxis) {
  const double bend = 10e-3 + 30e-3 * 60 * kDegree + 9.65e-3;
  const double s = 6e-3 + 2 * 25e-3 * 50 * kDegree + 5e-3, circle = std::numbers::pi * 36e-6;
  const auto cylinder = geometry::read_stl(kParts / "bent_cylinder.stl");
  EXPECT_NEAR(to_mm(cylinder->upper().z()), 46, 0.05);  // Han 2024, 4.2
  EXPECT_EQ(cylinder->open_edges(), 0);
  EXPECT_NEAR(cylinder->volume() / (circle * bend), 1, 4e-3);
  const auto bar = geometry::read_stl(kParts / "bent_bar.stl");
  EXPECT_EQ(bar->open_edges(), 0);
  EXPECT_NEAR(bar->volume() / (160e-6 * bend), 1, 4e-3);
  const auto tube = geometry::read_stl(kParts / "s_tube.stl");
  EXPECT_EQ(tube->open_edges(), 0);
  EXPECT_NEAR(tube->volume() / (circle * s), 1, 4e-3);
}

// Yu 2023, section 4. Areas of the sections: a cross with arms a third as wide is five squares of W / 3; a
// rounded corner that stands out has (1 - pi / 4) r^2 less, one in a hollow as much more: 8 and 4 of them.
TEST(Parts, ThePrismsHaveTheSectionsOfThePaper) {
  for (const auto& [name, width, radius] :
       {std::tuple{"cross_90.stl", 90e-3, 10e-3}, std::tuple{"cross_150.stl", 150e-3, 15e-3}}) {
    const auto cross = geometry::read_stl(kParts / name);
    EXPECT_NEAR(cross->upper().x() - cross->lower().x(), width, 1e-8) << name;
    EXPECT_NEAR(cross->upper().y() - cross->lower().y(), width, 1e-8) << name;
    const double area = 5 * width * width / 9 - 4 * (1 - std::numbers::pi / 4) * radius * radius;
    EXPECT_NEAR(cross->volume() / (area * 30e-3), 1, 1e-4) << name;
  }
  for (const auto& [name, a, b] :
       {std::tuple{"ellipse_50.stl", 50e-3, 35e-3}, std::tuple{"ellipse_75.stl", 75e-3, 45e-3}}) {
    const auto ellipse = geometry::read_stl(kParts / name);
    EXPECT_NEAR(ellipse->upper().x(), a, 1e-8) << name;
    EXPECT_NEAR(ellipse->upper().y(), b, 1e-8) << name;
    EXPECT_NEAR(ellipse->volume() / (std::numbers::pi * a * b * 30e-3), 1, 1e-4) << name;
  }
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

TEST(Parts, TheCrownAndItsCoreAreCylindersAShellApart) {
  const auto crown = geometry::read_stl(kParts / "crown.stl"),
             core = geometry::read_stl(kParts / "crown_core.stl");
  const auto base = geometry::read_stl(kParts / "crown_base.stl");
  // Facets of 0.3 mm: a sag of 0.3^2 / 8 / 40 = 0.28 um, and half as much again where they tilt by 17
  // degrees.
  for (double x = -11.9; x < 12; x += 0.37) {
    const double z = 20.41 - 40.39 + std::sqrt(40.39 * 40.39 - x * x);
    const auto top = crown->ray_hit(from_mm(1) * Vec3(x, 1.3, 100), -Vec3::UnitZ(), 1);
    ASSERT_TRUE(top);
    EXPECT_NEAR(to_mm(top->position.z()), z, 5e-4);
    // The last facet has its crease's normal at the end, and over it the core's own surface has ended.
    if (std::abs(x) < 11.6) {
      EXPECT_NEAR(to_deg(std::asin(top->normal.x())), to_deg(std::asin(x / 40.39)), 0.01);
      EXPECT_NEAR(to_mm(core->signed_distance(top->position)), 0.39, 6e-4);
    }
  }
  EXPECT_NEAR(to_mm(base->upper().z()), 18.2, 1e-5);
  for (const auto& part : {crown, core, base}) {
    EXPECT_EQ(part->open_edges(), 0);
    EXPECT_EQ(part->lower().z(), 0);
    EXPECT_NEAR(to_mm(part->upper().x()), 12, 1e-5);
    EXPECT_NEAR(to_mm(part->upper().y()), 6, 1e-5);
  }
  EXPECT_NEAR(base->volume() * 1e9, 24 * 12 * 18.2, 0.1);
}

}  // namespace
}  // namespace understudy
