#include "control/gap/gap_line.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::control {
namespace {

constexpr GapLineOptions kStiff{1, 0, 0};  // its slope and height are what they are

// Without walk and drift the filter is the least-squares line: its slope's variance is 12 / (n^3 - n) of a
// reading's, in steps.
TEST(GapLine, IsTheLeastSquaresLineWhereNothingWalks) {
  constexpr double kSigma = 5e-6, kStep = 0.1e-3;
  constexpr int kReadings = 40;
  GapLine line(kStiff);
  line.begin(0, 0);
  line.set_height(0, 0, 0.1e-3, 1);
  for (int k = 0; k < kReadings; ++k) {
    line.predict(k, k * kStep, 1);
    line.correct(0.13e-3 + 0.02 * k * kStep - line.height(), kSigma * kSigma);
  }
  EXPECT_NEAR(line.slope(), 0.02, 1e-7);
  EXPECT_NEAR(line.height(), 0.13e-3 + 0.02 * line.path(), 1e-9);
  const double slope_sigma = kSigma / kStep * std::sqrt(12 / (std::pow(kReadings, 3) - kReadings));
  EXPECT_NEAR(std::sqrt(line.covariance().slope), slope_sigma, 1e-4 * slope_sigma);
  // At the last of n readings: (4 n - 2) / (n^2 + n) of one.
  const double at_end = kSigma * std::sqrt((4.0 * kReadings - 2) / (kReadings * (kReadings + 1.0)));
  EXPECT_NEAR(std::sqrt(line.covariance().height), at_end, 1e-4 * at_end);
}

TEST(GapLine, ItsSlopeIsBelievedAsFarAsItIsTold) {
  GapLine line(kStiff);
  line.begin(0, 0);
  line.set_height(0, 0, 0, 1e-12);
  line.predict(0, 1e-3, 1);
  line.correct(20e-6, 1e-14);  // the slope has it: 0.02
  EXPECT_NEAR(line.height_at(2e-3, 1), 40e-6, 0.1e-6);
  EXPECT_NEAR(line.height_at(2e-3, 1.5e-3), 30e-6, 0.1e-6);
  EXPECT_NEAR(line.height_at(0.5e-3, 1), 20e-6, 0.1e-6) << "no farther back than its last reading";
}

// Slopes that walk in a hundred steps a millimetre and heights that drift: two predictions in a row state
// what 4000 draws scatter by, within three times the scatter's own error, 1 / sqrt(2 * 4000).
TEST(GapLine, StatesWhatASlopeThatWalksMakesOfTheHeight) {
  const GapLineOptions options{0.01, 0.3, 2e-6};
  constexpr double kStep = 1e-5, kTime = 4;  // [m], [s]
  constexpr int kDraws = 4000, kSteps = 200;
  double squares = 0;
  Random random(5, "lines");
  for (int draw = 0; draw < kDraws; ++draw) {
    double height = 3e-6 * random.normal(), slope = options.slope_sigma * random.normal();
    for (int k = 0; k < kSteps; ++k) {
      const double walked = std::sqrt(options.slope_walk * kStep) * random.normal();
      height += (slope + 0.5 * walked) * kStep;
      slope += walked;
    }
    height += options.drift * std::sqrt(kTime) * random.normal();
    squares += height * height / kDraws;
  }
  GapLine line(options);
  line.begin(0, 0);
  line.set_height(0, 0, 0, 9e-12);
  EXPECT_NEAR(std::sqrt(line.variance_at(kTime, kSteps * kStep)), std::sqrt(squares),
              3 * std::sqrt(squares) / std::sqrt(2.0 * kDraws));
  const double at_once = line.variance_at(kTime, kSteps * kStep);
  line.predict(1, 0.5e-3, 1);
  line.predict(3, 1.25e-3, 1);
  EXPECT_NEAR(line.variance_at(kTime, kSteps * kStep), at_once, 1e-9 * at_once);
}

}  // namespace
}  // namespace understudy::control
