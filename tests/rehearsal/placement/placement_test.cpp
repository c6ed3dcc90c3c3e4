// Where to put a program, against places that follow from the machine's dimensions by hand.
#include "rehearsal/placement/placement.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "geometry/box_mesh.h"
#include "geometry/mesh.h"
#include "kinematics/chain/chain.h"
#include "machine/description.h"
#include "rehearsal/rehearse.h"
#include "tests/machine/scara.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;

class PlacementSearched : public testing::Test {
 protected:
  RehearsalRequest request(const std::string& text, const std::string& machine) const {
    RehearsalRequest asked;
    asked.program = file("p.gcode", text);
    asked.machine = machine;
    asked.engine = "quasistatic";
    asked.as_built = "nominal";
    asked.keep_scene = false;
    return asked;
  }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  TemporaryFolder folder_;
};

constexpr const char* kStart = "G21 G90 M83\nM109 S210\nG28\n";

/// A bead around a rectangle [mm].
std::string rectangle(const Vec3& middle, double width, double depth) {
  std::string text = kStart;
  const auto corner = [&](double x, double y, const char* command, const std::string& rest) {
    text += fmt::format("{} X{:.4f} Y{:.4f} Z{:.4f}{}\n", command, middle.x() + x * width / 2,
                        middle.y() + y * depth / 2, middle.z(), rest);
  };
  corner(-1, -1, "G0", "");
  // 0.4 mm wide in a layer of 0.2 mm, of filament of 1.75 mm: 0.0297 mm for a millimetre.
  const std::string wide = fmt::format(" E{:.5f} F1200", 0.0297 * width),
                    deep = fmt::format(" E{:.5f} F1200", 0.0297 * depth);
  corner(1, -1, "G1", wide);
  corner(1, 1, "G1", deep);
  corner(-1, 1, "G1", wide);
  corner(-1, -1, "G1", deep);
  return text;
}

std::string circle(const Vec3& middle, double radius) {
  std::string text = kStart;
  for (int k = 0; k <= 72; ++k) {
    const double a = k * 5 * kDegree;
    text += fmt::format("G{} X{:.6f} Y{:.6f} Z{:.4f}{}\n", k == 0 ? 0 : 1, middle.x() + radius * std::cos(a),
                        middle.y() + radius * std::sin(a), middle.z(), k == 0 ? "" : " E0.02 F600");
  }
  return text;
}

double share_of(const Placement& placement, const std::string& name) {
  for (const LimitShare& limit : placement.limits)
    if (limit.name == name) return limit.share;
  ADD_FAILURE() << "no limit " << name;
  return 0;
}

// Slides of 120 mm about the middle: half the width on each side is missing from 60 mm.
TEST_F(PlacementSearched, ASquareStandsInTheMiddleOfTheTravel) {
  const Placement found = find_placement(request(rectangle({70, -30, 0.2}, 40, 20), "corexy"), {});
  EXPECT_TRUE(found.possible) << found.reason;
  EXPECT_NEAR(found.place.x_mm, -70, 1e-3);
  EXPECT_NEAR(found.place.y_mm, 30, 1e-3);
  EXPECT_EQ(found.place.z_mm, 0);
  EXPECT_EQ(found.place.turn_deg, 0) << "turning by a quarter is as good, and no better";
  EXPECT_EQ(found.least, "axis x");
  EXPECT_NEAR(found.margin, 1 - 20. / 60, 1e-6);
  EXPECT_NEAR(share_of(found, "axis y"), 1 - 10. / 60, 1e-6);
  EXPECT_NEAR(share_of(found, "axis z"), 1.7 / 60.75, 1e-6) << "the same everywhere: it only has to hold";
  ASSERT_TRUE(found.margin_as_given.has_value());
  EXPECT_NEAR(*found.margin_as_given, (60 - 90) / 10., 1e-6) << "the edge of the table, 10 mm being enough";
}

TEST_F(PlacementSearched, ALongBeadOnlyFitsAcrossTheCorner) {
  const Placement found = find_placement(request(rectangle({0, 0, 0.2}, 150, 2), "corexy"), {});
  EXPECT_TRUE(found.possible) << found.reason;
  EXPECT_NEAR(std::abs(found.place.turn_deg), 45, 1);
  EXPECT_NEAR(found.margin, 1 - (152 / std::numbers::sqrt2 / 2) / 60, 2e-3);
  PlacementOptions straight;
  straight.may_turn = false;
  const Placement none = find_placement(request(rectangle({0, 0, 0.2}, 150, 2), "corexy"), straight);
  EXPECT_FALSE(none.possible);
}

TEST_F(PlacementSearched, WhatIsLargerThanTheTableHasNoPlace) {
  PlacementOptions straight;
  straight.may_turn = false;
  const Placement none = find_placement(request(rectangle({30, 0, 0.2}, 150, 20), "corexy"), straight);
  EXPECT_FALSE(none.possible);
  EXPECT_NEAR(none.margin, (60 - 75) / 10., 1e-6);
  EXPECT_THAT(none.reason, HasSubstr("it prints 15.000 mm beyond the table's edge, at ("));
  EXPECT_THAT(none.reason, HasSubstr("(line 4)"));
  EXPECT_NEAR(none.place.x_mm, -30, 1e-3) << "the least bad";
}

// Three pairs of equal struts about the vertical through home: so is what they reach.
TEST_F(PlacementSearched, ACircleStandsOnTheAxisOfAHexapod) {
  const Placement found = find_placement(request(circle({13, -7, 40}, 10), "hexapod"), {});
  EXPECT_TRUE(found.possible) << found.reason;
  EXPECT_NEAR(found.place.x_mm, -13, 0.05);
  EXPECT_NEAR(found.place.y_mm, 7, 0.05);
}

/// The margin of a point on the table of kScara by hand: two arms of 200 mm from (-250, 0), the elbow to the
/// right, on a table of 200 mm.
double scara_margin(double x, double y) {
  const double r = std::hypot(x + 250, y);
  if (r >= 400) return -1;
  const double elbow = 2 * std::acos(r / 400), shoulder = std::atan2(y, x + 250) + elbow / 2;
  const double edge = std::min(100 - std::abs(x), 100 - std::abs(y)) / 10;
  return std::min({1 - to_deg(elbow) / 150, 1 - std::abs(to_deg(shoulder)) / 140, edge, 1.});
}

TEST_F(PlacementSearched, AScaraHasItsBestPlaceInItsAnnulus) {
  double best = -1;
  Vec2 place(0, 0);
  for (double x = -100; x <= 100; x += 0.25)
    for (double y = -100; y <= 100; y += 0.25)
      if (const double margin = scara_margin(x, y); margin > best) best = margin, place = {x, y};
  const std::string machine = file("machine.yaml", kScara);
  const Placement found = find_placement(request(circle({0, 0, 0.2}, 0.01), machine), {});
  EXPECT_TRUE(found.possible) << found.reason;
  EXPECT_NEAR(found.margin, best, 2e-3) << "a circle of 0.01 mm on a grid of 0.25 mm";
  EXPECT_NEAR(found.place.x_mm, place.x(), 0.5);
  EXPECT_NEAR(found.place.y_mm, place.y(), 0.5);
}

/// A bead of 120 mm along y on kScara, [mm]: the elbow is bent most in its middle.
std::string long_bead(double x, double y) {
  return kStart + fmt::format("G0 X{0} Y{1} Z0.2\nG1 X{0} Y{2} E3.56 F1200\n", x, y - 60, y + 60);
}

double long_bead_margin(double x, double y) {
  double margin = 1;
  for (double along = -60; along <= 60; along += 2.5) margin = std::min(margin, scara_margin(x, y + along));
  return margin;
}

TEST_F(PlacementSearched, PosesWithinAMoveCount) {
  const std::string machine = file("machine.yaml", kScara);
  // In the middle the arms span 190 mm: the elbow is at 2 acos(190 / 400), at the ends 7 degrees less.
  const Placement found = find_placement(request(long_bead(-60, 0), machine), {});
  EXPECT_NEAR(*found.margin_as_given, 1 - to_deg(2 * std::acos(190. / 400)) / 150, 1e-4);
}

TEST_F(PlacementSearched, WhatTheCheckFindsIsSearchedWith) {
  double best = -1;
  for (double x = -100; x <= 100; x += 0.5)
    for (double y = -40; y <= 40; y += 0.5) best = std::max(best, long_bead_margin(x, y));
  PlacementOptions straight;
  straight.may_turn = false;
  const std::string machine = file("machine.yaml", kScara);
  const Placement found = find_placement(request(long_bead(-60, 0), machine), straight);
  EXPECT_NEAR(found.margin, best, 5e-3) << "a grid of 0.5 mm, 10 mm of the edge being 1";
  EXPECT_NEAR(found.margin, long_bead_margin(found.place.x_mm - 60, found.place.y_mm), 1e-3);
}

TEST_F(PlacementSearched, AnArmTurnsItsToolOutOfTheWayOfItsLastAxis) {
  std::string arm = read_file((machine::models_folder() / "arm" / "machine.yaml").string());
  const std::string range = "range_deg: [-350, 350]";
  ASSERT_NE(arm.find(range), std::string::npos);
  arm.replace(arm.find(range), range.size(), "range_deg: [-20, 350]");  // at home it stands at 0
  const RehearsalRequest asked = request(rectangle({0, 0, 0.2}, 40, 20), file("machine.yaml", arm));
  PlacementOptions plain;
  plain.may_turn = plain.may_change_posture = false;
  const Placement as_it_is = find_placement(asked, plain);
  PlacementOptions turning;
  turning.may_change_posture = false;
  const Placement spun = find_placement(asked, turning);
  EXPECT_LT(share_of(as_it_is, "axis j6"), 0.4) << "2 (20 + a turn about the table of some degrees) / 370";
  EXPECT_NE(spun.place.spin_deg, 0);
  EXPECT_GT(spun.margin, as_it_is.margin + 0.02);
}

TEST_F(PlacementSearched, AnArmMayStandInAnotherPosture) {
  RehearsalRequest asked = request(rectangle({0, 0, 0.2}, 40, 20), "offset-wrist-arm");
  PlacementOptions options;
  options.may_turn = false;
  options.grid = 9;
  const Placement free = find_placement(asked, options);
  options.may_change_posture = false;
  const Placement held = find_placement(asked, options);
  ASSERT_EQ(free.place.home_axes.size(), 6u);
  EXPECT_TRUE(held.place.home_axes.empty());
  EXPECT_GT(free.margin, held.margin + 0.02);
  // Told to stand so, it has that margin there.
  const Placement told = find_placement(placed(asked, free.place), options);
  EXPECT_NEAR(*told.margin_as_given, free.margin, 1e-6);
}

/// Axes and condition alone, by the mechanism, for the four corners of a rectangle on the arm.
double arm_margin(const machine::MachineDescription& arm, const kinematics::Mechanism& mechanism,
                  const Vec2& middle, const Vec2& half, double z) {
  double margin = 1;
  for (const Vec2& sign : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
    const Vec2 p = middle + half.cwiseProduct(sign);
    const Pose X_BT =
        arm.X_WB.inverse() * make_pose(Mat3((arm.X_WB * arm.X_BT_home).linear()), Vec3(p.x(), p.y(), z));
    kinematics::AxisVector q{};
    if (mechanism.inverse(X_BT, {}, q) != kinematics::SolveStatus::ok) return -1;
    for (int i = 0; i < 6; ++i) {
      const auto range = mechanism.axis_range(i);
      const double at = q[static_cast<std::size_t>(i)];
      margin =
          std::min(margin, 2 * std::min(at - range.lower, range.upper - at) / (range.upper - range.lower));
    }
    margin = std::min(margin, 1 - std::log(mechanism.condition_number(X_BT, q)) / std::log(200.));
  }
  const geometry::Box& table = std::get<geometry::Box>(arm.table.form);
  const Vec2 room =
      table.size.head<2>() / 2 - (middle - arm.table.X_FS.translation().head<2>()).cwiseAbs() - half;
  return std::min(margin, room.minCoeff() / 10e-3);
}

TEST_F(PlacementSearched, AFineGridOverTheTableOfAnArmFindsNothingBetter) {
  const auto arm = machine::load_machine("arm");
  const auto mechanism = arm.make_mechanism();
  const Vec2 half(0.02, 0.01), side = std::get<geometry::Box>(arm.table.form).size.head<2>() / 2;
  double best = -1;
  for (double x = -side.x(); x <= side.x(); x += 2.5e-3)
    for (double y = -side.y(); y <= side.y(); y += 2.5e-3)
      best = std::max(best, arm_margin(arm, *mechanism, {x, y}, half, 0.2e-3));
  PlacementOptions plain;
  plain.may_turn = plain.may_change_posture = false;
  const Placement found = find_placement(request(rectangle({0, 0, 0.2}, 40, 20), "arm"), plain);
  const Vec2 place(from_mm(found.place.x_mm), from_mm(found.place.y_mm));
  EXPECT_NEAR(found.margin, arm_margin(arm, *mechanism, place, half, 0.2e-3), 2e-3)
      << "its corners are its farthest poses, but for a little";
  EXPECT_GE(found.margin, best - 2e-3);
}

/// A square post in the middle of the table, 10 mm high: the heater block passes above it. [m]
std::string post(double side) {
  const Vec3 half(side / 2, side / 2, 0);
  return geometry::write_stl(*geometry::box_mesh(-half, half + 10e-3 * Vec3::UnitZ()), "post");
}

// Both ends of the bead are 30 mm away from the post: only poses between them show it.
TEST_F(PlacementSearched, ABeadGoesPastAPostBetweenItsEnds) {
  RehearsalRequest asked = request(kStart + std::string("G0 X-30 Y0 Z0.2\nG1 X30 E1.78 F1200\n"), "corexy");
  asked.fixture = file("post.stl", post(0.004));
  PlacementOptions straight;
  straight.may_turn = false;
  const Placement found = find_placement(asked, straight);
  EXPECT_LT(*found.margin_as_given, 0);
  EXPECT_TRUE(found.possible) << found.reason;
  EXPECT_GT(std::abs(found.place.y_mm), 5) << "half the post and the nozzle at that height";
}

TEST_F(PlacementSearched, ItKeepsClearOfWhatStandsOnTheTable) {
  RehearsalRequest asked = request(rectangle({0, 0, 0.2}, 20, 20), "corexy");
  asked.fixture = file("clamp.stl", post(0.02));
  const Placement found = find_placement(asked, {});
  EXPECT_TRUE(found.possible) << found.reason;
  EXPECT_LT(*found.margin_as_given, 0) << "the nozzle runs into the clamp";
  EXPECT_GT(share_of(found, "clearance"), 0);
  EXPECT_GT(std::max(std::abs(found.place.x_mm), std::abs(found.place.y_mm)), 20) << "beside the clamp";
}

TEST_F(PlacementSearched, ARehearsalIsGoThereAndNoGoWhereTheProgramHasIt) {
  RehearsalRequest asked = request(rectangle({70, -30, 0.2}, 40, 20), "corexy");
  EXPECT_FALSE(rehearse(asked).go);
  asked.dialect.place_auto = true;
  const Record record = rehearse(asked);
  for (const Finding& finding : record.findings)
    EXPECT_NE(finding.severity, Severity::error) << finding.message;
  EXPECT_TRUE(record.go);
  ASSERT_TRUE(record.placement.has_value());
  EXPECT_EQ(record.placement->words, "--place -70,30,0");
  EXPECT_EQ(record.place_mm[0], -70);
}

TEST_F(PlacementSearched, ARehearsalWithoutAPlaceIsNoGoWithTheReason) {
  RehearsalRequest asked = request(rectangle({0, 0, 0.2}, 200, 200), "corexy");
  asked.dialect.place_auto = true;
  const Record record = rehearse(asked);
  EXPECT_FALSE(record.go);
  bool said = false;
  for (const Finding& finding : record.findings)
    said = said || (finding.kind == "placement" &&
                    finding.message.find("beyond the table's edge") != std::string::npos);
  EXPECT_TRUE(said);
}

using ExtendedPlacementSearched = PlacementSearched;

TEST_F(ExtendedPlacementSearched, TheSameEveryTime) {
  const RehearsalRequest asked = request(circle({13, -7, 40}, 10), "hexapod");
  const Placement a = find_placement(asked, {}), b = find_placement(asked, {});
  EXPECT_EQ(place_words(a.place), place_words(b.place));
  EXPECT_EQ(a.margin, b.margin);
  EXPECT_EQ(a.map.margin, b.map.margin);
}

TEST_F(PlacementSearched, WhatCannotBeMovedIsRefused) {
  const std::string slides = "G21 G90 M83\nG28\nG49\nG1 X0 Y0 Z30 B0 C0 F600\nG1 X5 E1\nG1 B20 C30 E1\n";
  EXPECT_THROW(find_placement(request(slides, "five-axis"), {}), InputError);
  EXPECT_THROW(find_placement(request("G28\nG0 X5 Y5 Z5\n", "corexy"), {}), InputError) << "prints nothing";
}

TEST_F(PlacementSearched, CanBeInterrupted) {
  const RehearsalRequest asked = request(circle({0, 0, 40}, 10), "hexapod");
  set_interrupted(true);
  EXPECT_THROW(find_placement(asked, {}), Interrupted);
  set_interrupted(false);
}

}  // namespace
}  // namespace understudy::rehearsal
