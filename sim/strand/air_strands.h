// Which of the material that does not lie on anything hangs in air as a strand, and how far it sags.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "machine/description.h"
#include "machine/material.h"
#include "sim/deposition/deposition.h"

namespace understudy::sim {

struct AirStrand {
  int line = 0;     ///< where it begins
  double time = 0;  ///< [s], there
  Vec3 from_W{0, 0, 0}, to_W{0, 0, 0};
  double length = 0;     ///< [m] of path
  double diameter = 0;   ///< [m]
  double speed = 0;      ///< [m/s] of the nozzle, mean
  double overfeed = 0;   ///< strand per path, less 1
  bool straight = true;  ///< solved as a beam-string between its ends; else as a frame along its path
  bool held_at_end = true;
  double sag = 0;  ///< [m], largest distance from where it was laid, when it is solid
  Vec3 sag_place_W{0, 0, 0};
  double solid_after = 0;  ///< [s], from the start of the strand until all of it is solid
  double duration = 0;     ///< [s], of laying it
  bool solved = true;      ///< false: a curved strand too long to be solved
  bool lies = false;       ///< it sags down to what lies below (or kGapReach, where nothing does)
  bool small = true;       ///< the model of small rotations holds; else the sag says no more than "large"
};

/// A stretch no longer than one of its widths for each end that is held: the groove between two rows below,
/// or a notch. A bead reaches across that by its own thickness.
bool spans_a_groove(const UnsupportedStretch& stretch);

/// A stretch is a strand in air when its beginning is held and either the way to what lies below is more than
/// two of its diameters somewhere, or it goes from printed material to a hold again: a bridge over a hollow
/// of the print. What is neither that nor spans a groove does not stick.
bool hangs_in_air(const UnsupportedStretch& stretch);

/// Straight strands, a corner of up to 5 % of the length beside the chord included, by compute_sag(), others
/// by compute_sag(). A strand that is fed faster than it leaves the nozzle freely is slack, one that is fed
/// slower is drawn thinner. Strands alike to 0.1 mm of length, 1 % of speed and so on are solved once a
/// thread.
///
/// They are solved on a thread beside the print; the results are the same whatever is solved where.
class AirStrandSolver {
 public:
  AirStrandSolver(const machine::MachineDescription& machine, const machine::Material& material);
  ~AirStrandSolver();
  AirStrandSolver(const AirStrandSolver&) = delete;
  AirStrandSolver& operator=(const AirStrandSolver&) = delete;

  /// What hangs_in_air(); others are passed over. Not from two threads at once.
  void add(const UnsupportedStretch& stretch);
  /// All strands in the order they came; the calling thread solves beside. Throws what solving threw.
  std::vector<AirStrand> finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
