#include "sim/surface/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

// ISO 4288, tables 1 and 3: up to which mean width or Ra a cut-off serves. [m]
struct CutoffRule {
  double cutoff, rsm_most, ra_most;
};
constexpr std::array<CutoffRule, 5> kRules{{{0.08e-3, 0.04e-3, 0.02e-6},
                                            {0.25e-3, 0.13e-3, 0.1e-6},
                                            {0.8e-3, 0.4e-3, 2e-6},
                                            {2.5e-3, 1.3e-3, 10e-6},
                                            {8e-3, 4e-3, 80e-6}}};
constexpr int kSamplingLengths = 5;      // ISO 4288
constexpr double kPointsPerCutoff = 10;  // fewer do not carry the weighting function
constexpr double kElementHeight = 0.1;   // of Rz: lower peaks and valleys do not part elements (ISO 4287)
constexpr double kWhole = 1 + 1e-9;      // a length of a whole number of pitches has them all

// In points of the profile.
struct Evaluation {
  std::size_t first = 0, per_length = 0;
  int lengths = 0;
};

std::optional<Evaluation> evaluation(std::size_t points, double pitch, double cutoff) {
  const auto per_length = static_cast<std::size_t>(std::lround(cutoff / pitch));
  if (static_cast<double>(per_length) < kPointsPerCutoff || points < 2 * per_length) return std::nullopt;
  const std::size_t lengths = std::min<std::size_t>(kSamplingLengths, points / per_length - 1);
  return Evaluation{(points - lengths * per_length) / 2, per_length, static_cast<int>(lengths)};
}

// Mean width of the profile elements: between mean-line crossings of one sense, of a profile that goes beyond
// the band of too small heights on both sides in between.
std::optional<double> mean_width(std::span<const double> z, double pitch, double band) {
  int side = 0;
  double rise = 0, first = 0, last = 0;
  std::size_t elements = 0;
  bool begun = false, below = false;
  for (std::size_t i = 1; i < z.size(); ++i) {
    if (z[i - 1] < 0 && z[i] >= 0) rise = static_cast<double>(i - 1) + z[i - 1] / (z[i - 1] - z[i]);
    if (z[i] < -band) {
      side = -1;
      below = true;
    }
    if (z[i] > band && side < 1) {
      side = 1;
      if (!below) continue;
      if (begun)
        ++elements;
      else
        first = rise;
      begun = true;
      last = rise;
    }
  }
  if (elements == 0) return std::nullopt;
  return (last - first) * pitch / static_cast<double>(elements);
}

std::span<const double> evaluated(const std::vector<double>& z, const Evaluation& part) {
  return std::span(z).subspan(part.first, part.per_length * static_cast<std::size_t>(part.lengths));
}

Roughness parameters(const std::vector<double>& z, double pitch, double cutoff, const Evaluation& part) {
  Roughness result;
  for (int k = 0; k < part.lengths; ++k) {
    const auto length =
        evaluated(z, part).subspan(static_cast<std::size_t>(k) * part.per_length, part.per_length);
    double sum = 0, squares = 0, peak = length[0], valley = length[0];
    for (const double height : length) {
      sum += std::abs(height);
      squares += height * height;
      peak = std::max(peak, height);
      valley = std::min(valley, height);
    }
    const auto count = static_cast<double>(part.per_length);
    result.ra += sum / count / part.lengths;
    result.rq += std::sqrt(squares / count) / part.lengths;
    result.rz += (peak - valley) / part.lengths;
  }
  result.rsm = mean_width(evaluated(z, part), pitch, kElementHeight * result.rz);
  result.cutoff = cutoff;
  result.sampling_lengths = part.lengths;
  result.evaluation_from = static_cast<double>(part.first) * pitch;
  result.evaluation_length = static_cast<double>(part.per_length) * pitch * part.lengths;
  return result;
}

std::size_t rule_of_rsm(double rsm) {
  std::size_t rule = 0;
  while (rule + 1 < kRules.size() && rsm > kRules[rule].rsm_most) ++rule;
  return rule;
}

std::size_t rule_of_ra(double ra) {
  std::size_t rule = 0;
  while (rule + 1 < kRules.size() && ra > kRules[rule].ra_most) ++rule;
  return rule;
}

// What is seen before a cut-off is chosen: the profile less its least-squares line.
std::size_t first_guess(std::span<const double> heights, double pitch) {
  const auto count = static_cast<double>(heights.size());
  const double middle = 0.5 * (count - 1);
  double sum = 0, moment = 0, square = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double s = static_cast<double>(i) - middle;
    sum += heights[i];
    moment += s * heights[i];
    square += s * s;
  }
  std::vector<double> z(heights.size());
  double mean = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = heights[i] - sum / count - moment / square * (static_cast<double>(i) - middle);
    mean += std::abs(z[i]) / count;
  }
  const auto [low, high] = std::minmax_element(z.begin(), z.end());
  const auto rsm = mean_width(z, pitch, kElementHeight * (*high - *low));
  return rsm ? rule_of_rsm(*rsm) : rule_of_ra(mean);
}

// ISO 4288, 7.2: measure with the cut-off of the estimate, change it until the result asks for the one in
// use.
Roughness by_rule(std::span<const double> heights, double pitch, const RoughnessSettings& settings) {
  std::optional<std::size_t> smallest, largest;
  for (std::size_t rule = 0; rule < kRules.size(); ++rule) {
    if (!evaluation(heights.size(), pitch, kRules[rule].cutoff)) continue;
    if (!smallest) smallest = rule;
    largest = rule;
  }
  if (!largest)
    throw InputError(
        fmt::format("the profile of {:.6g} mm at {:.6g} um has no room for a cut-off of ISO 4288: twice "
                    "0.08 mm, and 10 points in it",
                    to_mm(pitch * static_cast<double>(heights.size())), to_um(pitch)));
  std::array<bool, kRules.size()> tried{};
  std::size_t wanted = first_guess(heights, pitch);
  for (;;) {
    const std::size_t rule = std::clamp(wanted, *smallest, *largest);
    const double cutoff = kRules[rule].cutoff;
    Roughness result = parameters(roughness_profile(heights, pitch, cutoff, settings.short_cutoff), pitch,
                                  cutoff, *evaluation(heights.size(), pitch, cutoff));
    tried[rule] = true;
    const std::size_t next = result.rsm ? rule_of_rsm(*result.rsm) : rule_of_ra(result.ra);
    const std::size_t asked = std::clamp(next, *smallest, *largest);
    // Two cut-offs that each ask for the other: the longer one keeps more of the surface.
    if (asked == rule || (tried[asked] && asked < rule)) {
      result.cutoff_is_standard = asked != rule || next == rule;
      return result;
    }
    wanted = next;
  }
}

void check(std::span<const double> heights, double pitch, const RoughnessSettings& settings) {
  if (!(pitch > 0 && std::isfinite(pitch)))
    throw InputError(fmt::format("the profile's pitch is {:.6g} um, not above 0", to_um(pitch)));
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (!std::isfinite(heights[i]))
      throw InputError(fmt::format("the profile's height number {} is not finite", i + 1));
  const double length = pitch * static_cast<double>(heights.size());
  if (settings.cutoff) {
    const double cutoff = *settings.cutoff;
    if (!(cutoff * kWhole >= kPointsPerCutoff * pitch && std::isfinite(cutoff)))
      throw InputError(
          fmt::format("the cut-off is {:.6g} mm, less than {:.6g} mm, ten pitches of the profile",
                      to_mm(cutoff), to_mm(kPointsPerCutoff * pitch)));
    if (!evaluation(heights.size(), pitch, cutoff))
      throw InputError(fmt::format("the cut-off is {:.6g} mm, more than {:.6g} mm, half of the profile",
                                   to_mm(cutoff), to_mm(0.5 * length)));
  }
  if (settings.short_cutoff) {
    const double most = settings.cutoff.value_or(kRules.front().cutoff);
    if (!(*settings.short_cutoff >= 2 * pitch && *settings.short_cutoff < most))
      throw InputError(
          fmt::format("the short cut-off is {:.6g} um, not from {:.6g} um (two pitches) to {:.6g} um",
                      to_um(*settings.short_cutoff), to_um(2 * pitch), to_um(most)));
  }
}

}  // namespace

std::vector<double> gaussian_mean_line(std::span<const double> heights, double pitch, double cutoff) {
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  const auto reach = static_cast<std::ptrdiff_t>(std::floor(cutoff / pitch * kWhole));
  std::vector<double> weights(static_cast<std::size_t>(reach) + 1);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double x = static_cast<double>(k) * pitch / (alpha * cutoff);
    weights[k] = std::exp(-std::numbers::pi * x * x);
  }
  const auto count = static_cast<std::ptrdiff_t>(heights.size());
  std::vector<double> line(heights.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    // Weighted straight line through the neighbourhood, read at its middle: where the weights are
    // symmetrical this is the plain weighted mean.
    double s0 = 0, s1 = 0, s2 = 0, z0 = 0, z1 = 0;
    const std::ptrdiff_t last = std::min(count - 1, i + reach);
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, i - reach); k <= last; ++k) {
      const auto d = static_cast<double>(k - i);
      const double w = weights[std::abs(k - i)], z = heights[k];
      s0 += w;
      s1 += w * d;
      s2 += w * d * d;
      z0 += w * z;
      z1 += w * d * z;
    }
    const double determinant = s0 * s2 - s1 * s1;
    line[i] = determinant > 0 ? (s2 * z0 - s1 * z1) / determinant : z0 / s0;
  }
  return line;
}

std::vector<double> roughness_profile(std::span<const double> heights, double pitch, double cutoff,
                                      std::optional<double> short_cutoff) {
  std::vector<double> primary(heights.begin(), heights.end());
  if (short_cutoff) primary = gaussian_mean_line(primary, pitch, *short_cutoff);
  const std::vector<double> mean = gaussian_mean_line(primary, pitch, cutoff);
  for (std::size_t i = 0; i < primary.size(); ++i) primary[i] -= mean[i];
  return primary;
}

Roughness roughness(std::span<const double> heights, double pitch, const RoughnessSettings& settings) {
  check(heights, pitch, settings);
  if (!settings.cutoff) return by_rule(heights, pitch, settings);
  const double cutoff = *settings.cutoff;
  Roughness result = parameters(roughness_profile(heights, pitch, cutoff, settings.short_cutoff), pitch,
                                cutoff, *evaluation(heights.size(), pitch, cutoff));
  const std::size_t asked = result.rsm ? rule_of_rsm(*result.rsm) : rule_of_ra(result.ra);
  result.cutoff_is_standard = std::abs(cutoff - kRules[asked].cutoff) < 1e-3 * cutoff;
  return result;
}

}  // namespace understudy::sim
