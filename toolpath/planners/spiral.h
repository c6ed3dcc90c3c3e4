// A helix drawn in the air, with the tool leaning along the curve (Song 2015, 6.1 and figure 14).
#pragma once

#include "toolpath/program.h"

namespace understudy::toolpath {

struct SpiralPlan {
  Vec3 centre = Vec3::Zero();    ///< [m], on the table, below the helix's axis
  double radius = 0;             ///< [m], of the tip's path
  double pitch = 0;              ///< [m], rise per turn
  double turns = 0;              ///< counter-clockwise
  double gap = 0;                ///< [m], tip above the table where the helix begins
  double lean = 0;               ///< [rad], of the tool from vertical, towards where it goes
  double lean_turns = 0;         ///< over which the tool takes its lean up, upright at the start
  double strand_diameter = 0;    ///< [m]
  double chord_tolerance = 0;    ///< [m], of the straight moves from the helix
  double feed = 0;               ///< [m/s]
  double approach_feed = 0;      ///< [m/s]
  double clearance = 0;          ///< [m], along the tool, before the start and after the end
  double end_dwell = 0;          ///< [s], at the end, for the strand to solidify
  double filament_diameter = 0;  ///< [m]
  double temperature = 0;        ///< [K]
  double fan = 0;                ///< 0..1
};

/// Tool at the angle `phi` [rad] from the start. The axis leans in the vertical plane of the tangent by
/// `lean` times s^2 (3 - 2 s), s the part of lean_turns done, and never beyond the tangent itself.
Pose spiral_pose(const SpiralPlan& plan, double phi);

/// [m], of the whole helix.
double spiral_length(const SpiralPlan& plan);

/// The strand's volume is its cross-section times the helix's length, as if drawn without stretch. Throws
/// InputError for values out of range, a pitch below two strands, or a lean above 60 degrees.
Program plan_spiral(const SpiralPlan& plan);

}  // namespace understudy::toolpath
