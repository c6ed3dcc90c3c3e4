// Pose repeatability by ISO 9283: how far apart the attained positions lie when a pose is approached again
// and again. Of what scatters in a real machine only the play of the axes is modelled (docs/quasistatic.md):
// an axis whose load is above friction lies where the load pushes it; another one is on the side of its play
// from which it came.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "machine/description.h"

namespace understudy::studies {

struct RepeatabilityOptions {
  Vec3 centre = Vec3(0, 0, 0.1);  ///< [m], of the standard's cube, in W
  double edge = 0.25;             ///< [m], of the cube; poses lie 0.4 edges from its centre (ISO 9283, 6.8.4)
  double lean = 0;                ///< [rad], of the tool's axis from upright, about -y
  int cycles = 30;                ///< approaches of a pose in a test (ISO 9283, 7.2.2)
  int tests = 20;                 ///< of each pose, whose mean is told: 30 approaches alone scatter by 8 %
  std::optional<double> friction;  ///< [N] or [N m], of every axis; else the machine's
  bool one_side = false;           ///< every approach from the same side
  std::uint64_t seed = 1;
  std::string command;  ///< for the record
};

struct PoseRepeatability {
  Vec3 position = Vec3::Zero();  ///< [m], in W
  double repeatability = 0;      ///< [m]: mean distance from the centre of what was attained, and three sigma
};

struct Repeatability {
  std::string machine;
  RepeatabilityOptions options;
  std::vector<PoseRepeatability> poses;  ///< centre of the cube, then four corners of a diagonal plane
  double mean = 0, largest = 0;          ///< [m]
};

/// Throws InputError naming option, value and limit, and for a pose that the machine does not reach;
/// Interrupted.
Repeatability repeatability(const machine::MachineDescription& machine, const RepeatabilityOptions& options);

}  // namespace understudy::studies
