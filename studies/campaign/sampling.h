// Points of the space that a campaign's parameters span.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "studies/campaign/campaign.h"

namespace understudy::studies {

/// One value for each parameter, as text that a file may hold.
using ParameterValues = std::vector<std::string>;

/// The parameter's value at `share` 0..1 of its range, along its scale.
double scaled(const CampaignParameter& parameter, double share);
/// To nine significant digits: a key of a file, and a column of a table.
std::string value_text(double value);

/// Every combination, the last parameter changing first. Without parameters one empty point.
std::vector<ParameterValues> grid_points(const std::vector<CampaignParameter>& parameters);

/// `count` points in [0, 1)^dimensions, of which each of `count` equal slices along each axis holds one
/// (McKay 1979), at random within it. They depend on nothing else.
std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t dimensions);

/// The first `count` points of the Sobol sequence after the origin (Joe and Kuo 2008).
std::vector<std::vector<double>> sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace understudy::studies
