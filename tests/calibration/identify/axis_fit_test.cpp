// One axis' parameters from commanded and measured positions: on rows whose answer is known, and on noise.
#include "calibration/identify/axis_fit.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::calibration {
namespace {

constexpr double kTurn = 1.5875e-3;  // [m]
constexpr double kNoise = 0.4e-6;    // [m]

struct Truth {
  double zero = 210e-6, play = 80e-6, scale = 0.3e-3, lag = 0.2e-3, sine = 4e-6, cosine = -2e-6;
};

/// Back and forth over 30 mm, with a load that changes sides a few times.
std::vector<AxisRow> rows_of(const Truth& truth, double noise, std::uint64_t seed, int count = 600,
                             bool both_sides = true) {
  Random random(seed, "rows");
  std::vector<AxisRow> rows;
  for (int k = 0; k < count; ++k) {
    AxisRow row;
    row.time = 0.05 * k;
    row.commanded = 20e-3 + 15e-3 * std::sin(0.31 * row.time);
    row.velocity = 15e-3 * 0.31 * std::cos(0.31 * row.time);
    const double side = both_sides && std::sin(0.47 * row.time) < -0.2 ? -0.5 : 0.5;
    const double angle = 2 * std::numbers::pi * row.commanded / kTurn;
    row.measured = row.commanded + truth.zero + truth.scale * row.commanded - truth.lag * row.velocity +
                   truth.sine * std::sin(angle) + truth.cosine * (std::cos(angle) - 1) + side * truth.play +
                   noise * random.normal();
    rows.push_back(row);
  }
  return rows;
}

AxisFit fit(const std::vector<AxisRow>& rows, double noise = kNoise) {
  AxisFitOptions options;
  options.noise = noise;
  options.turn = kTurn;
  return fit_axis(rows, options);
}

TEST(AxisFit, FindsEveryParameterOfRowsWithoutNoise) {
  const Truth truth;
  const AxisFit found = fit(rows_of(truth, 0, 1));
  EXPECT_NEAR(found.of(AxisParameter::zero), truth.zero, 1e-11);
  EXPECT_NEAR(found.of(AxisParameter::play), truth.play, 1e-11);
  EXPECT_NEAR(found.of(AxisParameter::scale), truth.scale, 1e-9);
  EXPECT_NEAR(found.of(AxisParameter::lag), truth.lag, 1e-8);
  EXPECT_NEAR(found.of(AxisParameter::sine), truth.sine, 1e-11);
  EXPECT_NEAR(found.of(AxisParameter::cosine), truth.cosine, 1e-11);
  EXPECT_GT(found.side_changes, 3);
  for (const std::string& why : found.untold) EXPECT_EQ(why, "");
}

TEST(AxisFit, ErrorsAndChiSquareAreWhatTheNoiseMakesThem) {
  const Truth truth;
  constexpr int kDraws = 200;
  double chi_square = 0, chi_square_squared = 0, zero = 0, play = 0, scale = 0;
  int degrees = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const AxisFit found = fit(rows_of(truth, kNoise, 100 + static_cast<std::uint64_t>(draw)));
    degrees = found.degrees_of_freedom;
    chi_square += found.chi_square / kDraws;
    chi_square_squared += found.chi_square * found.chi_square / kDraws;
    const auto score = [&](AxisParameter p, double true_value) {
      const double s = (found.of(p) - true_value) / found.sigma(p);
      return s * s / kDraws;
    };
    zero += score(AxisParameter::zero, truth.zero);
    play += score(AxisParameter::play, truth.play);
    scale += score(AxisParameter::scale, truth.scale);
  }
  ASSERT_EQ(degrees, 600 - 6);
  // The mean of 200 draws of n degrees has a sigma of sqrt(2 n / 200); their variance is 2 n within 40 % (4
  // sigma).
  EXPECT_NEAR(chi_square, degrees, 4 * std::sqrt(2.0 * degrees / kDraws));
  EXPECT_NEAR((chi_square_squared - chi_square * chi_square) / (2.0 * degrees), 1, 0.4);
  // Squared scores have mean 1 with a sigma of sqrt(2 / 200).
  for (const double squared : {zero, play, scale}) EXPECT_NEAR(squared, 1, 0.4);
}

TEST(AxisFit, NoPlayIsToldWhereOneSideWasSeen) {
  const AxisFit found = fit(rows_of({}, kNoise, 7, 600, false));
  EXPECT_FALSE(found.told(AxisParameter::play));
  EXPECT_EQ(found.of(AxisParameter::play), 0);
  EXPECT_NE(found.untold[static_cast<std::size_t>(AxisParameter::play)].find("one side"), std::string::npos);
  EXPECT_NEAR(found.of(AxisParameter::zero), Truth{}.zero + 0.5 * Truth{}.play, 1e-6);
}

TEST(AxisFit, NoiseAloneIsNoPlay) {
  Truth truth;
  truth.play = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    EXPECT_FALSE(fit(rows_of(truth, kNoise, seed)).told(AxisParameter::play)) << seed;
}

TEST(AxisFit, AWaveThatTheModelLacksIsAMisfitAndNoPlay) {
  Truth truth;
  truth.play = 0;
  std::vector<AxisRow> rows = rows_of(truth, kNoise, 3);
  for (AxisRow& row : rows) row.measured += 5e-6 * std::sin(2.0 * row.time);
  const AxisFit found = fit(rows);
  EXPECT_FALSE(found.told(AxisParameter::play));
  EXPECT_GT(found.chi_square, 50 * found.degrees_of_freedom);
  // What the model lacks is in the stated uncertainty.
  EXPECT_GT(found.sigma(AxisParameter::zero), 5 * kNoise / std::sqrt(600.0));
}

TEST(AxisFit, RowsOnTheWayAcrossThePlayAreLeftOut) {
  std::vector<AxisRow> rows = rows_of({}, kNoise, 5);
  // Eight rows of a change of sides are caught between both ends.
  int spoiled = 0;
  for (std::size_t k = 1; k < rows.size() && spoiled < 8; ++k) {
    const double jump =
        (rows[k].measured - rows[k].commanded) - (rows[k - 1].measured - rows[k - 1].commanded);
    if (std::abs(jump) < 60e-6) continue;
    rows[k].measured -= jump > 0 ? 35e-6 : -35e-6;
    ++spoiled;
  }
  ASSERT_GE(spoiled, 4);
  const AxisFit found = fit(rows);
  EXPECT_EQ(found.left_out, spoiled);
  EXPECT_NEAR(found.of(AxisParameter::play), Truth{}.play, 0.3e-6);
}

TEST(AxisFit, AnAxisThatRestsTellsItsZeroOnly) {
  std::vector<AxisRow> rows(50);
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = {0.01 * static_cast<double>(k), 20e-3, 0, 20e-3 + 5e-6};
  const AxisFit found = fit(rows);
  EXPECT_TRUE(found.told(AxisParameter::zero));
  EXPECT_NEAR(found.of(AxisParameter::zero), 5e-6, 1e-12);
  for (const AxisParameter p :
       {AxisParameter::play, AxisParameter::scale, AxisParameter::lag, AxisParameter::sine})
    EXPECT_FALSE(found.told(p)) << to_string(p);
}

TEST(AxisFit, TooFewRowsTellNothing) {
  const AxisFit found = fit(rows_of({}, kNoise, 1, 10));
  for (const std::string& why : found.untold) EXPECT_NE(why, "");
}

}  // namespace
}  // namespace understudy::calibration
