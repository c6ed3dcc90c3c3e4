// One row of the comparison of engines: the same motion and play in all of them.
#pragma once

#include <optional>

#include "bench/plant/reference_motions.h"

namespace understudy::sim {

struct EngineResult {
  double peak_error = 0;  ///< [m], largest distance of the tip from its command
  int flips = 0;
};
/// How an engine's tip differs from the MuJoCo plant's at the same time.
struct EngineDifference {
  double peak_error = 0;  ///< [m], of the two peak errors
  double median = 0;      ///< [m], over time
  double largest = 0;     ///< [m], at any time: while a strut is on its way through its play
};
struct EngineComparison {
  EngineResult mujoco, bullet;
  EngineDifference bullet_difference, quasistatic_difference;
};

/// `play` [m], a strut's total; an axis of an arm gets it over kArmReach as an angle.
constexpr double kArmReach = 0.5;  // [m]
EngineComparison compare_engines(const machine::MachineDescription& machine, const ReferenceMotion& motion,
                                 double play, double timestep);

}  // namespace understudy::sim
