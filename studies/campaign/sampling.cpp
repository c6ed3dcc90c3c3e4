#include "studies/campaign/sampling.h"

#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <boost/random/sobol.hpp>

#include "core/assert.h"
#include "core/random.h"

namespace understudy::studies {

double scaled(const CampaignParameter& parameter, double share) {
  if (parameter.scale == ParameterScale::linear)
    return parameter.from + share * (parameter.to - parameter.from);
  return parameter.from * std::pow(parameter.to / parameter.from, share);
}

std::string value_text(double value) { return fmt::format("{:.9g}", value); }

std::vector<ParameterValues> grid_points(const std::vector<CampaignParameter>& parameters) {
  std::vector<ParameterValues> points{{}};
  for (const CampaignParameter& parameter : parameters) {
    std::vector<ParameterValues> longer;
    for (const ParameterValues& point : points)
      for (const std::string& value : parameter.values) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points = std::move(longer);
  }
  return points;
}

std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t dimensions) {
  std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
  for (std::size_t d = 0; d < dimensions; ++d) {
    Random random(1, fmt::format("latin hypercube {}", d));
    std::vector<std::size_t> slice(count);
    std::iota(slice.begin(), slice.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i)  // Fisher and Yates
      std::swap(slice[i - 1], slice[random.bits() % i]);
    for (std::size_t i = 0; i < count; ++i)
      points[i][d] = (static_cast<double>(slice[i]) + random.uniform()) / static_cast<double>(count);
  }
  return points;
}

std::vector<std::vector<double>> sobol_points(std::size_t count, std::size_t dimensions) {
  UNDERSTUDY_ASSERT(dimensions >= 1, "a sequence has an axis at least");
  boost::random::sobol_engine<std::uint_least64_t, 53> sequence(dimensions);
  constexpr double kUnit = 0x1p-53;
  std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
  for (auto& point : points)
    for (double& x : point) x = static_cast<double>(sequence()) * kUnit;
  return points;
}

}  // namespace understudy::studies
