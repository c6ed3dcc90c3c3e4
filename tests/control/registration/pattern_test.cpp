#include "control/registration/pattern.h"

#include <Eigen/LU>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/control/gap/bead_program.h"
#include "tests/geometry/test_solids.h"
#include "tests/temporary_folder.h"

namespace understudy::control {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const PartTolerance kTolerance{0.2e-3, 2e-3, 1e-3};

/// A slab with a top of 40 x 40 mm at 20 mm over the hexapod's table.
const geometry::Mesh& slab() {
  static const auto box = geometry::box({-20e-3, -20e-3, 0}, {20e-3, 20e-3, 20e-3});
  static const geometry::Mesh mesh(box.vertices, box.triangles);
  return mesh;
}

ProbingCheck slab_check() { return {hexapod(), slab(), largest_shift(slab(), kTolerance)}; }

/// A file that goes with the test.
struct PatternFile {
  explicit PatternFile(const std::string& rows) { std::ofstream(path) << "x_mm,y_mm,z_mm\n" << rows; }
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "pattern.csv";
};

std::string refusal(const std::string& rows) {
  const PatternFile file(rows);
  try {
    read_pattern(file.path, slab(), slab_check());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Variance of the height at a corner of the top, known from heights at these places to 1 each.
double corner_variance(const std::vector<ProbingPlace>& places) {
  Mat3 information = Mat3::Zero();
  for (const auto& place : places) {
    const Vec3 row(1, place.p_W.x() / 20e-3, place.p_W.y() / 20e-3);
    information += row * row.transpose();
  }
  const Vec3 corner(1, 1, 1);
  return corner.dot(information.inverse() * corner);
}

// On a flat the best places for height and slopes are its corners: four of them, 8 readings, leave 3 / 8 of
// the variance of one reading at a corner; spread evenly over the top they would leave more.
TEST(Pattern, OnAFlatThePlacesGoToItsEnds) {
  const auto places = choose_places(slab(), kTolerance, slab_check(), {}, 8);
  ASSERT_EQ(places.size(), 8u);
  for (const auto& place : places) {
    EXPECT_NEAR(place.p_W.z(), 20e-3, 1e-9) << "the hexapod cannot lean over the sides";
    EXPECT_NEAR(place.normal_W.z(), 1, 1e-9);
    EXPECT_GT(place.p_W.head<2>().cwiseAbs().maxCoeff(), 12e-3) << "at the rim, as near as the dot allows";
    EXPECT_LT(place.p_W.head<2>().cwiseAbs().maxCoeff(), 19e-3);
    for (const auto& other : places) {
      if (&other == &place) continue;
      EXPECT_GE((other.p_W - place.p_W).norm(), 3e-3);
    }
  }
  EXPECT_LT(corner_variance(places), 1.0);
}

// The bead of the program lies at x from 0 to 10 mm: within 12 mm of it is x > -12 mm.
TEST(Pattern, ThePlacesAreNearWhatIsPrinted) {
  toolpath::Program program = bead_program();
  for (auto& step : program.steps) step.X_WT.translation().z() = 20e-3 + kGap;
  const PrintedRegion region = printed_region(program);
  EXPECT_EQ(region.path_W.size(), 2u);
  EXPECT_NEAR(region.lean_max, 0, 1e-9);
  for (const auto& place : choose_places(slab(), kTolerance, slab_check(), region, 8))
    EXPECT_GT(place.p_W.x(), 5e-3 - 12e-3);
}

TEST(Pattern, APartThatCannotBeLookedAtIsToldSo) {
  const auto needle = geometry::box({-1e-3, -1e-3, 0}, {1e-3, 1e-3, 30e-3});
  const geometry::Mesh part(needle.vertices, needle.triangles);
  const ProbingCheck check(hexapod(), part, largest_shift(part, kTolerance));
  try {
    choose_places(part, kTolerance, check, {}, 9);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("0 places"), HasSubstr("at least 6")));
  }
}

constexpr const char* kGood = "0,0,20\n10,0,20\n-10,0,20\n0,10,20\n0,-10,20\n10,10,20\n";

TEST(Pattern, ReadsPlacesOfTheDrawnPart) {
  const PatternFile file(std::string(kGood) + "# beside by what a drawing rounds\n-10,-10,20.05\n");
  const auto places = read_pattern(file.path, slab(), slab_check());
  ASSERT_EQ(places.size(), 7u);
  EXPECT_EQ(places[6].line, 9);
  EXPECT_NEAR(places[6].p_W.z(), 20e-3, 1e-12) << "put onto the part";
}

TEST(Pattern, RefusesWhatThePartDoesNotCarry) {
  EXPECT_THAT(refusal(std::string(kGood) + "-10,-10,20.3\n"),
              AllOf(HasSubstr(".csv:8"), HasSubstr("0.300 mm off"), HasSubstr("0.1 mm")));
  EXPECT_THAT(refusal(std::string(kGood) + "10.01,0,20\n"), AllOf(HasSubstr(":8"), HasSubstr("line 3")));
  EXPECT_THAT(refusal(std::string(kGood) + "20,0,10\n"),
              AllOf(HasSubstr(":8"), HasSubstr("cannot be measured")));
  EXPECT_THAT(refusal(std::string(kGood) + "19.5,0,20\n"), AllOf(HasSubstr(":8"), HasSubstr("ends")));
  EXPECT_THAT(refusal("0,0,20\n5,5,20\n"), AllOf(HasSubstr("2 places"), HasSubstr("6")));
  EXPECT_THAT(refusal("0,zero,20\n"), HasSubstr(":2"));
  EXPECT_THAT(refusal("0,0,20\n1e308,0,20\n"), AllOf(HasSubstr(":3"), HasSubstr("beyond 100000 mm")));
}

}  // namespace
}  // namespace understudy::control
