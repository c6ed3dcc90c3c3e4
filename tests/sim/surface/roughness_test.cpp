#include "sim/surface/roughness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kPitch = 5e-6;
constexpr double kPi = std::numbers::pi;

std::vector<double> profile(double length, const std::function<double(double)>& height,
                            double pitch = kPitch) {
  std::vector<double> z(static_cast<std::size_t>(std::lround(length / pitch)) + 1);
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = height(pitch * static_cast<double>(i));
  return z;
}

std::vector<double> sine(double length, double wavelength, double amplitude) {
  return profile(length, [=](double x) { return amplitude * std::sin(2 * kPi * x / wavelength); });
}

// ISO 16610-21, 4.2: share of a sine's amplitude that the mean line keeps.
double transmission(double wavelength, double cutoff) {
  return std::exp(-kPi * std::numbers::ln2 / kPi * std::pow(cutoff / wavelength, 2));
}

RoughnessSettings with_cutoff(double cutoff) {
  RoughnessSettings settings;
  settings.cutoff = cutoff;
  return settings;
}

TEST(GaussianFilter, PassesWhatItsTransferFunctionSays) {
  const double cutoff = 0.8e-3, amplitude = 1e-6;
  EXPECT_DOUBLE_EQ(transmission(cutoff, cutoff), 0.5);
  for (const double ratio : {0.4, 0.5, 0.8, 1.0, 1.6, 2.5, 8.0}) {
    const auto z = sine(8e-3, ratio * cutoff, amplitude);
    const auto mean = gaussian_mean_line(z, kPitch, cutoff);
    // Away from the ends by a cut-off. Beyond that the weights that are left out sum to 1e-6 of them.
    for (std::size_t i = 160; i + 160 < z.size(); ++i)
      ASSERT_NEAR(mean[i], transmission(ratio * cutoff, cutoff) * z[i], 4e-6 * amplitude) << ratio;
  }
}

TEST(GaussianFilter, KeepsAStraightLineUpToItsEnds) {
  const auto z = profile(5e-3, [](double x) { return 3e-6 + 0.01 * x; });
  const auto mean = gaussian_mean_line(z, kPitch, 0.8e-3);
  for (std::size_t i = 0; i < z.size(); ++i) ASSERT_NEAR(mean[i], z[i], 1e-15);  // of 5e-5 m, sums of 300
}

TEST(Roughness, OfASineIsTheTextbooks) {
  const double amplitude = 10e-6, wavelength = 0.2e-3;
  const auto z = sine(20e-3, wavelength, amplitude);
  const Roughness r = roughness(z, kPitch, with_cutoff(2.5e-3));
  // 40 points a wave: their mean magnitude is the integral's to (pi/40)^2 / 3, peaks fall on points.
  EXPECT_NEAR(r.ra, 2 * amplitude / kPi, 2.1e-3 * amplitude);
  EXPECT_NEAR(r.rq, amplitude / std::sqrt(2.0), 1e-6 * amplitude);
  EXPECT_NEAR(r.rz, 2 * amplitude, 1e-6 * amplitude);
  ASSERT_TRUE(r.rsm);
  EXPECT_NEAR(*r.rsm, wavelength, 1e-3 * wavelength);  // crossings are interpolated linearly
  EXPECT_EQ(r.sampling_lengths, 5);
  EXPECT_NEAR(r.evaluation_length, 12.5e-3, 1e-12);
}

TEST(Roughness, LosesTheWavinessAtTheCutoff) {
  for (const double cutoff : {0.25e-3, 0.8e-3, 2.5e-3}) {
    const double wavelength = cutoff;
    const auto z = sine(6 * cutoff, wavelength, 10e-6);
    const Roughness r = roughness(z, kPitch, with_cutoff(cutoff));
    EXPECT_EQ(r.sampling_lengths, 5);
    // Run-in is half a cut-off: in the outer half of the first and last length the weights are cut off by up
    // to 2 %, which costs some 2 % of Rz there.
    EXPECT_NEAR(r.rz, 2 * 10e-6 * (1 - transmission(wavelength, cutoff)), 0.01 * 10e-6) << cutoff;
  }
}

TEST(Roughness, OfSquareStepsOnASlopeIsThatOfTheirTriangle) {
  const double layer = 0.2e-3;
  for (const double slope_deg : {20.0, 45.0, 70.0}) {
    const double slope = from_deg(slope_deg), width = layer / std::sin(slope),
                 depth = layer * std::cos(slope);
    const double pitch = width / 200;
    const double uphill = width * std::cos(slope) * std::cos(slope);  // of one period, along the tread
    const auto z = profile(
        200 * width,
        [&](double x) {
          const double at = std::fmod(x + 1e-9 * width, width);
          return at < uphill ? depth * at / uphill : depth * (width - at) / (width - uphill);
        },
        pitch);
    const Roughness r = roughness(z, pitch, with_cutoff(20 * width));
    // 200 points a step, whose corners fall between them.
    EXPECT_NEAR(r.ra, layer * std::cos(slope) / 4, 2e-3 * depth) << slope_deg;
    EXPECT_NEAR(r.rz, depth, 0.015 * depth) << slope_deg;
    EXPECT_NEAR(*r.rsm, width, 0.01 * width) << slope_deg;
  }
}

TEST(Roughness, RzIsAMeanOverTheSamplingLengths) {
  auto z = profile(4.8e-3, [](double) { return 0.0; });
  const double spike = 100e-6;
  z[480] = spike;  // in the third of five sampling lengths
  const Roughness r = roughness(z, kPitch, with_cutoff(0.8e-3));
  EXPECT_EQ(r.sampling_lengths, 5);
  // The mean line rises by the spike's weight, 1.3 % of it; half a cut-off on it is down to 3 % of that.
  EXPECT_NEAR(r.rz, spike / 5, 0.001 * spike);
}

TEST(Roughness, ChoosesTheCutoffOfTheStandard) {
  // ISO 4288, table 3: 0.04 < RSm <= 0.13 mm: 0.25 mm, and so on.
  const std::vector<std::pair<double, double>> table{
      {0.1e-3, 0.25e-3}, {0.3e-3, 0.8e-3}, {1.0e-3, 2.5e-3}, {2.5e-3, 8e-3}};
  for (const auto& [wavelength, cutoff] : table) {
    const Roughness r = roughness(sine(60e-3, wavelength, 20e-6), kPitch);
    EXPECT_DOUBLE_EQ(r.cutoff, cutoff) << wavelength;
    EXPECT_TRUE(r.cutoff_is_standard);
    EXPECT_EQ(r.sampling_lengths, 5);
  }
}

TEST(Roughness, SaysWhenTheLineIsTooShortForTheStandard) {
  const Roughness fewer = roughness(sine(3e-3, 0.3e-3, 20e-6), kPitch);
  EXPECT_DOUBLE_EQ(fewer.cutoff, 0.8e-3);
  EXPECT_TRUE(fewer.cutoff_is_standard);
  EXPECT_EQ(fewer.sampling_lengths, 2);  // and one to run in
  const Roughness shorter = roughness(sine(1e-3, 0.3e-3, 20e-6), kPitch);
  EXPECT_DOUBLE_EQ(shorter.cutoff, 0.25e-3);
  EXPECT_FALSE(shorter.cutoff_is_standard);
}

TEST(Roughness, SmoothsByTheShortCutoffFirst) {
  const double wavelength = 0.1e-3;
  RoughnessSettings settings = with_cutoff(0.8e-3);
  settings.short_cutoff = wavelength;
  const Roughness r = roughness(sine(5e-3, wavelength, 10e-6), kPitch, settings);
  EXPECT_NEAR(r.rz, 10e-6, 1e-3 * 10e-6);  // half of 2 A; 20 points a wave
}

TEST(Roughness, RefusesWhatMakesNoSense) {
  const auto z = sine(5e-3, 0.3e-3, 20e-6);
  EXPECT_THAT([&] { roughness(z, kPitch, with_cutoff(4e-3)); },
              ThrowsMessage<InputError>(HasSubstr("the cut-off is 4 mm, more than 2.5")));
  EXPECT_THAT([&] { roughness(z, kPitch, with_cutoff(0.04e-3)); },
              ThrowsMessage<InputError>(HasSubstr("the cut-off is 0.04 mm, less than 0.05 mm")));
  EXPECT_THROW(roughness(z, 0, {}), InputError);
  EXPECT_THROW(roughness(z, kPitch, with_cutoff(-1)), InputError);
  EXPECT_THROW(roughness({}, kPitch), InputError);
  EXPECT_THAT([] { roughness(sine(0.1e-3, 0.05e-3, 1e-6), kPitch); },
              ThrowsMessage<InputError>(HasSubstr("no room for a cut-off")));
  RoughnessSettings settings = with_cutoff(0.8e-3);
  settings.short_cutoff = 0.8e-3;
  EXPECT_THROW(roughness(z, kPitch, settings), InputError);
  auto broken = z;
  broken[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { roughness(broken, kPitch); }, ThrowsMessage<InputError>(HasSubstr("height number 8")));
}

}  // namespace
}  // namespace understudy::sim
