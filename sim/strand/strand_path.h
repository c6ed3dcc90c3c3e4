// How far a strand drawn through air along a curve sags from the programmed path while it hardens, like the
// spiral that Song 2015 draws in air (figure 14).
#pragma once

#include <vector>

#include "core/frames.h"
#include "machine/material.h"
#include "sim/deposition/cooling.h"

namespace understudy::sim {

/// The first point stands on something that holds the strand in place and direction. The nozzle holds the
/// point that it is at, until it leaves at the last.
struct AirPath {
  std::vector<Vec3> points_W;     ///< [m], programmed; W's z is up
  std::vector<double> laid_at;    ///< [s], increasing, one a point
  std::vector<bool> supported;    ///< one a point, or empty: held in place from when it is laid, free to turn
  double diameter = 0;            ///< [m], of the round strand
  double nozzle_temperature = 0;  ///< [K]; 0: the material's
  Surroundings surroundings;
  bool end_supported = false;  ///< the last point stays where it is, in place and direction
};

struct PathSag {
  std::vector<Vec3> displacement_W;  ///< [m], of each point from the programmed one when all is solid
  double sag_max = 0;                ///< [m], largest of their norms
  std::size_t sag_max_point = 0;
  double drop_max = 0;       ///< [m], largest downward component
  double sag_at_end = 0;     ///< [m], largest norm when the nozzle is at the last point
  double time_to_solid = 0;  ///< [s], of a section
  double solid_at = 0;       ///< [s], of laid_at's clock, when every section is solid
  double rotation_max = 0;   ///< [rad]
  bool small = true;  ///< rotation_max is below 0.3 rad; else the sag says no more than that it is large
};

struct PathOptions {
  int elements_of_hot_length = 8;  ///< at least, of the strand's part that is above the glass transition
  int cooling_steps = 40;          ///< time steps while a section cools to the glass transition, at least
};

/// Throws InputError for a path, diameter, temperature or time that is none. 100 points: some 0.1 s.
PathSag compute_sag(const machine::Material& material, const AirPath& path, const PathOptions& options = {});

}  // namespace understudy::sim
