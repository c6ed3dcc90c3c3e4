// What a user tunes of the controller: the planner's and the gap control's settings, sections `planner` and
// `gap_control` of machine.yaml. Their defaults stand here and nowhere else.
#pragma once

namespace understudy::machine {

struct PlannerSettings {
  double lookahead = 0.2;     ///< [m] of path that is planned ahead
  double corner_share = 0.5;  ///< of an axis' acceleration in a cycle that a corner may take
  double lead_time = 0.05;    ///< [s], a stretch begins this far ahead: time to plan its first batch
  double gap_reserve = 0.02;  ///< of the axes' velocity and acceleration, kept for what gap control adds
};

/// How the gap is closed before a bead (control/gap/gap_controller.h).
struct GapApproachSettings {
  double tolerance = 8e-6;      ///< [m], stop when the reading is this near to the aim
  double step_fraction = 0.7;   ///< of the distance left, while farther than `slow_zone`
  double slow_zone = 0.15e-3;   ///< [m], above the aim: frames are averaged and steps shortened here
  int frames_averaged = 3;      ///< in the slow zone; the tip creeps between them, so speckle changes
  int stops_max = 40;           ///< steps before giving up
  double residual_max_px = 12;  ///< farther off its line, the dot is implausible
  double depth_max = 4e-3;    ///< [m], below S: a surface that lies lower is not the one that was programmed
  double settle_time = 0.05;  ///< [s], rest before an exposure
  double frame_age_max = 0.25;  ///< [s]
  double retreat = 2e-3;        ///< [m], along the tool axis, after a stop for a reason
};

/// The line that the gap is estimated as (control/gap/gap_line.h).
struct GapLineSettings {
  double slope_sigma = 0.025;  ///< [m/m], before it was measured
  double slope_walk = 0.04;    ///< [1/m], variance of the slope's change over a metre
  double drift = 2e-6;         ///< [m/sqrt(s)], of the height of a tool at rest
};

/// How the gap is followed along a bead (control/gap/gap_follower.h).
struct GapFollowingSettings {
  double rate_max = 0.5e-3;         ///< [m/s], of the correction
  double acceleration_max = 20e-3;  ///< [m/s^2], of the correction: it is smooth
  double travel_max = 0.5e-3;       ///< [m], of the correction: the open-loop error of the paper's machine
  double settle_time = 0.03;        ///< [s], in which a small step of the estimate is taken over
  double gate = 4;                  ///< standard deviations that a reading may be off
  double unmodelled = 2e-6;         ///< [m], a reading may be off besides: facets and roughness
  int step_samples = 4;             ///< in a row that show the same lasting step of the machine
  double extrapolated_max = 1e-3;   ///< [m] of path beyond the last good reading; the correction rests then
  double blind_time = 0.5;          ///< [s] without a good reading ...
  double blind_path = 1.5e-3;       ///< [m] ... and at least so far, is a stop: longer than a bead is wide
  double blind_time_max = 3;        ///< [s], however slow
  double silent_time_max = 1;       ///< [s] of excitation without an answer: four of them
};

struct GapControlSettings {
  GapApproachSettings approach;
  GapFollowingSettings following;
  GapLineSettings line;  ///< part of the section `following`
};

struct ControlSettings {
  PlannerSettings planner;
  GapControlSettings gap;
};

}  // namespace understudy::machine
