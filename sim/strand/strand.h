// How far a strand drawn through air sags: it cools by age, is laid from one support to another by a moving
// nozzle, creeps while it is above the glass transition and is elastic below (docs/strand.md).
#pragma once

#include <vector>

#include "machine/material.h"
#include "sim/deposition/cooling.h"
#include "sim/strand/strand_beam.h"

namespace understudy::sim {

/// A straight strand from a first support to a second.
struct AirSpan {
  double length = 0;              ///< [m], chord between the supports
  double diameter = 0;            ///< [m], of the round strand
  double speed = 0;               ///< [m/s] of the nozzle along the chord
  double nozzle_temperature = 0;  ///< [K]; 0: the material's
  double slope = 0;               ///< [rad], of the chord above the horizontal in the direction of the nozzle
  double overfeed = 0;            ///< strand laid per chord, less 1; negative where the strand is drawn
  bool slack_kept =
      true;  ///< overfeed becomes length; false: the hot strand is also free to creep thicker instead
  Surroundings surroundings;
  Hold start = Hold::clamped;   ///< clamped or pinned
  Hold nozzle = Hold::clamped;  ///< clamped or pinned, while printing
  Hold end = Hold::clamped;     ///< from arrival on; free where the far end reaches no support
};

struct StrandOptions {
  int elements = 40;       ///< of the chord, at least; more where a short part of it is hot
  int cooling_steps = 40;  ///< time steps while a section cools to the glass transition, at least
};

struct StrandResult {
  std::vector<double> position;  ///< [m] along the chord from the first support
  std::vector<double> sag;       ///< [m], below the chord, across it, when the strand is solid
  double sag_max = 0;            ///< [m], largest either way; negative where that is above the chord
  double sag_max_position = 0;   ///< [m]
  double sag_middle = 0;         ///< [m], at half of the chord
  double sag_at_arrival = 0;     ///< [m], largest either way when the nozzle arrives
  double time_to_solid = 0;      ///< [s], from the nozzle to the glass transition
  double solid_at = 0;           ///< [s] from the start until every section is solid
  double hot_length = 0;         ///< [m] of strand above the glass transition behind the moving nozzle
  bool start_solid_before_arrival = false;  ///< the first section was solid before the nozzle arrived
  bool falls = false;    ///< nothing holds it: the sag is beyond the chord's length or not found
  double slope_max = 0;  ///< [rad]: the model is good while this is below about 0.3
  double length_gain =
      0;  ///< of the strand over its chord, by stretching and overfeed, as a share of the chord
  /// [m]: the sag that this length has as one bow, chord sqrt(3/8 length_gain). Kept overfeed folds into
  /// several bows that are flatter; this is what it hangs down by at most.
  double sag_one_bow = 0;
  double biot = 0;  ///< at the nozzle temperature: one temperature for a section is good below about 0.2
};

/// Throws InputError for a span, speed, temperature, overfeed or hold that is none, and for surroundings in
/// which the strand never becomes solid. One to three milliseconds with the options' defaults.
StrandResult compute_sag(const machine::Material& material, const AirSpan& span,
                         const StrandOptions& options = {});

}  // namespace understudy::sim
