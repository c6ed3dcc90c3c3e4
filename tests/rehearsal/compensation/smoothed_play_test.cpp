#include "rehearsal/compensation/smoothed_play.h"

#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

toolpath::Program one_line(double length) {
  toolpath::Program program;
  toolpath::Step step;
  step.kind = toolpath::StepKind::print;
  step.X_WT = make_pose(Mat3(Mat3::Identity()), Vec3(length, 0, 0));
  program.steps.push_back(step);
  return program;
}

/// A play that crosses in the middle of the line.
PlayAlongPath crossing(double shift) {
  PlayAlongPath play;
  Twist none = Twist::Zero(), some = Twist::Zero();
  some[2] = shift;
  for (const double at : {0.0, 0.4999}) play.add({0, at}, none);
  for (const double at : {0.5001, 1.0}) play.add({0, at}, some);
  return play;
}

TEST(SmoothedPlay, AStepBecomesARampOfTwiceItsReach) {
  SmoothedPlay smooth(one_line(0.1), Pose::Identity(), 4e-3);
  smooth.add(crossing(80e-6));
  EXPECT_NEAR(smooth.at(0, 0.5, 1)[2], 40e-6, 1e-9) << "half of it in the middle, by symmetry";
  EXPECT_NEAR(smooth.at(0, 0.45, 1)[2], 0, 1e-12) << "5 mm before";
  EXPECT_NEAR(smooth.at(0, 0.55, 1)[2], 80e-6, 1e-12);
  double last = 0;
  for (double f = 0.46; f < 0.54; f += 0.0025) {
    EXPECT_GE(smooth.at(0, f, 1)[2], last);
    // 21 taps of a raised cosine: the largest weight is 2 / 22.
    EXPECT_LE(smooth.at(0, f, 1)[2] - last, 80e-6 * 2 / 22 + 1e-9);
    last = smooth.at(0, f, 1)[2];
  }
}

TEST(SmoothedPlay, ShortStepsThatGoOnAreOneWayAndASharpCornerEndsIt) {
  // Ten steps of 1 mm straight on, then one across; the play crosses between the fifth and the sixth.
  toolpath::Program program;
  toolpath::Step step;
  step.kind = toolpath::StepKind::print;
  for (int i = 1; i <= 10; ++i) {
    step.X_WT.translation() = Vec3(1e-3 * i, 0, 0);
    program.steps.push_back(step);
  }
  step.X_WT.translation() = Vec3(10e-3, 5e-3, 0);
  program.steps.push_back(step);
  SmoothedPlay smooth(program, Pose::Identity(), 4e-3);
  PlayAlongPath play;
  Twist none = Twist::Zero(), some = Twist::Zero(), other = Twist::Zero();
  some[2] = 80e-6;
  other[2] = -80e-6;
  for (std::size_t i = 0; i < 10; ++i)
    for (const double at : {0.001, 1.0}) play.add({i, at}, i < 5 ? none : some);
  for (const double at : {0.001, 1.0}) play.add({10, at}, other);
  smooth.add(play);
  EXPECT_NEAR(smooth.at(4, 1, 1)[2], 40e-6, 5e-6) << "half in the middle, but for the tap that falls on it";
  EXPECT_GT(smooth.at(3, 0.5, 1)[2], 1e-6) << "over the joints of steps";
  EXPECT_NEAR(smooth.at(9, 0.5, 1)[2], 80e-6, 1e-9) << "what comes behind the corner does not count";
}

TEST(SmoothedPlay, EachFurtherPredictionCountsHalf) {
  SmoothedPlay smooth(one_line(0.1), Pose::Identity(), 1e-3);
  smooth.add(crossing(80e-6));
  smooth.add(crossing(40e-6));
  EXPECT_NEAR(smooth.at(0, 1, 2)[2], 60e-6, 1e-12);
  smooth.add(crossing(0));
  EXPECT_NEAR(smooth.at(0, 1, 3)[2], 30e-6, 1e-12);
}

// So the print begins where the travel ends.
TEST(SmoothedPlay, ATravelEndsWithTheCorrectionOfThePrintThatItLeadsTo) {
  toolpath::Program program = one_line(0.1);
  program.steps[0].kind = toolpath::StepKind::travel;
  toolpath::Step print;
  print.kind = toolpath::StepKind::print;
  print.X_WT = make_pose(Mat3(Mat3::Identity()), Vec3(0.1, 0.05, 0));
  program.steps.push_back(print);
  SmoothedPlay smooth(program, Pose::Identity(), 4e-3);
  PlayAlongPath play;
  Twist travels = Twist::Zero(), prints = Twist::Zero();
  travels[2] = -80e-6;
  prints[2] = 60e-6;
  for (const double at : {0.001, 1.0}) play.add({0, at}, travels);
  for (const double at : {0.001, 1.0}) play.add({1, at}, prints);
  smooth.add(play);
  EXPECT_EQ(smooth.run(0), smooth.run(1));
  EXPECT_NEAR(smooth.at(0, 1, 1)[2], smooth.at(1, 0, 1)[2], 1e-12);
  EXPECT_NEAR(smooth.at(0, 0.2, 1)[2], smooth.at(1, 0, 1)[2], 1e-12) << "all along the travel";
  EXPECT_NEAR(smooth.at(1, 0.5, 1)[2], 60e-6, 1e-9);
  smooth.add(play);
  EXPECT_NEAR(smooth.at(1, 0.5, 1)[2], 60e-6, 1e-9);
  EXPECT_EQ(smooth.at(1, 0.5, 0)[2], 0) << "no prediction, no correction";
}

}  // namespace
}  // namespace understudy::rehearsal
