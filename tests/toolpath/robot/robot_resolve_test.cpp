// Which output feeds, which base the part stands in, which way the tool points.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/robot/robot_path.h"

namespace understudy::toolpath {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A bead of 0.5 x 0.2 mm.
RobotOptions options() {
  RobotOptions o;
  o.X_WT_home = make_pose(Quat::Identity(), Vec3(0, 0, 60e-3));
  o.extruder.bead_area = 0.0914159265358979e-6;
  return o;
}

Pose at(double x_mm, const Mat3& R) { return make_pose(R, Vec3(from_mm(x_mm), 0, 5e-3)); }
Mat3 about_y(double degrees) {
  return Eigen::AngleAxisd(from_deg(degrees), Vec3::UnitY()).toRotationMatrix();
}

RobotPath path(const Mat3& R) {
  RobotPath path("p.src");
  path.set_line(1);
  path.free(at(0, R));
  path.set_output("OUT[1]", 1, false);
  path.straight(at(10, R), 0.02);
  path.set_output("OUT[1]", 0, false);
  path.straight(at(20, R), 0.02);
  return path;
}

std::string rejection(const RobotPath& path, const RobotOptions& o) {
  try {
    resolve(path, o);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// Whatever axis of the program's tool points down, the nozzle does.
TEST(RobotResolve, TheAxisOfTheToolThatPointsDownPointsOutOfTheNozzle) {
  const Mat3 about_x = Eigen::AngleAxisd(from_deg(90), Vec3::UnitX()).toRotationMatrix();
  const std::vector<std::pair<Mat3, std::string>> cases{{Mat3::Identity(), "-z"}, {about_y(180), "z"},
                                                        {about_y(90), "x"},       {about_y(-90), "-x"},
                                                        {about_x, "-y"},          {about_x.transpose(), "y"}};
  for (const auto& [R, axis] : cases) {
    RobotOptions o = options();
    RobotFacts facts;
    o.facts = &facts;
    const Program program = resolve(path(R), o);
    EXPECT_EQ(facts.tool_points, axis);
    for (const Step& step : program.steps) {
      EXPECT_TRUE(tool_axis(step.X_WT).isApprox(Vec3::UnitZ(), 1e-9)) << axis;
      EXPECT_NEAR(step.X_WT.linear().determinant(), 1, 1e-9) << axis;
    }
  }
}

TEST(RobotResolve, AToolWhoseDirectionCannotBeToldIsAskedFor) {
  EXPECT_THAT(rejection(path(about_y(45)), options()), HasSubstr("say so by --tool-points"));
  RobotOptions o = options();
  o.tool_points = "-z";
  const Program program = resolve(path(about_y(45)), o);
  EXPECT_NEAR(tool_axis(program.steps.front().X_WT).x(), std::sqrt(0.5), 1e-9);
}

TEST(RobotResolve, TheSignalIsTheOnlyOutputOrIsNamed) {
  RobotPath two = path(about_y(180));
  two.set_output("OUT[9]", 1, false);
  EXPECT_EQ(rejection(two, options()),
            "p.src: the program sets OUT[1] (2 times), OUT[9] (1 time): say by --signal which of them feeds "
            "filament");
  RobotOptions o = options();
  o.extruder.outputs = {"$out[1]"};
  const Program program = resolve(two, o);
  ASSERT_EQ(program.steps.size(), 3u);
  EXPECT_EQ(program.steps[1].kind, StepKind::print);
  EXPECT_EQ(program.steps[2].kind, StepKind::move);
  o.extruder.outputs = {"OUT[2]"};
  EXPECT_THAT(rejection(two, o), HasSubstr("sets no output 'OUT[2]', but OUT[1] (2 times), OUT[9]"));
  o.extruder.outputs = {"OUT[1]", "OUT[9]"};
  EXPECT_THAT(rejection(two, o), HasSubstr("one switched output, one analogue output, or one of each"));
}

TEST(RobotResolve, HowMuchASignalFeedsMustBeSaid) {
  RobotOptions o = options();
  o.extruder.bead_area.reset();
  EXPECT_THAT(rejection(path(about_y(180)), o), HasSubstr("OUT[1] feeds filament, but how much"));
  o.extruder.flow_per_unit = 2e-9;  // 2 mm3/s in 0.5 s
  EXPECT_NEAR(to_mm(resolve(path(about_y(180)), o).steps[1].filament), 1 / 2.405282, 1e-5);
}

TEST(RobotResolve, WithoutASignalAllIsMotionUnlessEveryMovePrints) {
  RobotPath silent("p.src");
  silent.straight(at(0, about_y(180)), 0.02);
  silent.straight(at(10, about_y(180)), 0.02);
  RobotOptions o = options();
  for (const Step& step : resolve(silent, o).steps) EXPECT_EQ(step.kind, StepKind::move);
  o.extruder.outputs = {"always"};
  EXPECT_EQ(resolve(silent, o).steps.back().kind, StepKind::print);
}

TEST(RobotResolve, AMoveOfTheRobotsOwnWhileItFeedsIsRefused) {
  RobotPath path("p.src");
  path.straight(at(0, about_y(180)), 0.02);
  path.set_output("OUT[1]", 1, false);
  path.set_line(7);
  path.free(at(10, about_y(180)));
  EXPECT_THAT(rejection(path, options()),
              HasSubstr("p.src:7: a PTP, MoveJ or axis move while the extruder is on"));
}

TEST(RobotResolve, WaitingWithASwitchedSignalFeedsNothingAndIsCounted) {
  RobotPath waiting = path(about_y(180));
  waiting.set_output("OUT[1]", 1, false);
  waiting.wait(3);
  RobotFacts facts;
  RobotOptions o = options();
  o.facts = &facts;
  EXPECT_EQ(resolve(waiting, o).steps.back().kind, StepKind::dwell);
  EXPECT_EQ(facts.rest_with_signal, 3);
  EXPECT_THAT(facts.signal, ElementsAre("OUT[1]"));
}

}  // namespace
}  // namespace understudy::toolpath
