// Beads laid where the true tip went, with the true gap (Song 2015, 3.3: above 0.2 mm nothing sticks).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "machine/description.h"
#include "sim/deposition/gap_band.h"
#include "sim/deposition/workpiece.h"
#include "sim/observer.h"

namespace understudy::sim {

/// How an element lies on what is below it.
enum class Adhesion {
  sticks,       ///< supported, gap in reach, warm enough
  fused,        ///< over a bead of its own height: pressed into its place, no gap to speak of
  unsupported,  ///< higher above what is below than a bead sticks, or nothing is below
  cold,         ///< on an earlier bead, the interface below the glass transition
  buried,       ///< the tip at or below the surface
};

/// An element of at least 0.1 mm of path, longer while path, section and adhesion stay the same; shorter only
/// where extrusion pauses or the adhesion changes. Filament fed at a standstill belongs to the element that
/// goes on from there; where the tip leaves instead, it stays behind as an element without length.
struct LaidBead {
  Vec3 from_W{0, 0, 0};  ///< [m], on the surface below the tip; the tip itself where it is unsupported
  Vec3 to_W{0, 0, 0};
  Vec3 normal_W{0, 0, 1};  ///< tool axis
  double length = 0;       ///< [m] of path on the surface; of the strand, where it is unsupported
  double path = 0;         ///< [m] of the tip's path
  double gap = 0;          ///< [m], mean over the element
  double width = 0;        ///< [m], from conserved volume at this gap
  double height = 0;       ///< [m]
  double volume = 0;       ///< [m^3]
  Adhesion adhesion = Adhesion::sticks;
  double start_time = 0, time = 0;  ///< [s], at its ends
  int start_line = 0, line = 0;     ///< at its ends
  bool follows = false;             ///< goes on where the element before it ends
};

/// Path above the band on which the drive feeds and no bead comes to lie: it primes the nozzle after a
/// retraction, or a drop falls.
struct BarePath {
  double length = 0;     ///< [m]
  Vec3 from_W{0, 0, 0};  ///< of the tip
  int line = 0;          ///< of the program
};

/// Consecutive elements that do not stick, for the same reason.
struct UnsupportedStretch {
  Adhesion adhesion = Adhesion::unsupported;
  int line = 0;                      ///< where it begins
  double time = 0;                   ///< [s], there
  Vec3 place_W{0, 0, 0};             ///< there
  double length = 0;                 ///< [m]
  double volume = 0;                 ///< [m^3]
  double worst_gap = 0;              ///< [m], farthest from the band
  double highest_gap = 0;            ///< [m], upper end of the band where it begins
  double interface_temperature = 0;  ///< [K], lowest, of a cold one
  double nozzle_temperature = 0;     ///< [K]
  double fan = 0;                    ///< 0..1
  bool held_at_start = false;        ///< goes on from material that holds it, or begins in touch with some
  bool held_at_end = false;
  bool on_printed = false;      ///< what held it last is printed material: it bridges a hollow of the print
  double width = 0;             ///< [m], of its line, or of what was laid before it
  BarePath bare_before;         ///< right before it
  std::vector<Vec3> path_W;     ///< [m], of an unsupported one: middle of the strand as laid
  std::vector<double> laid_at;  ///< [s], one a point of path_W
  std::vector<int> lines;       ///< of the program, likewise
};

/// Where the gap is deepest below its band, or least above its lower end.
struct LowestGap {
  double gap = 0, accepted_min = 0;  ///< [m]
  double time = 0;                   ///< [s]
  int line = 0;
};

struct DepositionSummary {
  double length = 0;            ///< [m] of path on the surface while extruding
  double in_band_fraction = 0;  ///< of that length with the gap in the accepted band
  double below_band_fraction = 0, above_band_fraction = 0;  ///< the rest
  double gap_min = 0, gap_mean = 0, gap_max = 0;  ///< [m], weighted by length, where a surface is below
  int gap_min_line = 0;
  double gap_min_time = 0;  ///< [s]
  LowestGap lowest;
  double start_gap = 0;         ///< [m], true gap where extrusion began first
  double fused_length = 0;      ///< [m], counted in no gap figure
  double extruded_volume = 0;   ///< [m^3], net: what a retraction took back is not counted twice
  double laid_volume = 0;       ///< [m^3], of all elements, sticking or not
  double deposited_volume = 0;  ///< [m^3], of those that stick
  /// [m^3], fed at a standstill and left behind: elements without length, and drops that fall, which come out
  /// by themselves with nothing below and are shorter than wide.
  double standstill_volume = 0;
  double column_volume = 0;  ///< [m^3], not laid: what still presses to come out, and a drop at the nozzle
  std::size_t beads = 0;
};

struct DepositionOptions {
  /// The band of a line of the program; nothing: the machine's everywhere.
  std::function<GapBand(int line)> band;
  /// [K] of an earlier bead's surface after that many seconds, with this much fan; nothing: it is at ambient.
  std::function<double(double age, double fan)> substrate_temperature;
  double glass_transition = 0;                ///< [K]; an interface below it does not weld
  std::function<void(const LaidBead&)> laid;  ///< called for every element, in order
  std::function<void(const UnsupportedStretch&)>
      on_unsupported;  ///< called for every stretch that does not stick, at its end
};

/// Between snapshots tip, gap and feed are taken as linear, so that fractions and the ends of unsupported
/// stretches do not depend on the snapshots' rate where the true motion is. What lies below is the workpiece
/// without the freshest material, which is still under the nozzle: the last nozzle flat and two bead widths
/// of path.
///
/// What is fed while the tip comes down along the tool through the air, as after a travel, hangs from the
/// nozzle, and comes to lie where the tip stops coming down. After ten bores of such path it is laid on the
/// way instead, as a strut that is drawn downwards, and the nozzle runs into it.
///
/// Beyond one ray along the tool axis, an element whose middle has nothing in reach is held where half of
/// its width has (an overhang).
class DepositionObserver : public Observer {
 public:
  DepositionObserver(const machine::MachineDescription& machine, std::shared_ptr<Workpiece> workpiece,
                     DepositionOptions options = {});
  ~DepositionObserver() override;
  void observe(const Snapshot& snapshot) override;
  /// The print is over: what is still in the nozzle stays at the last element.
  void finish();

  /// [m], true gap at the last snapshot; infinity: nothing below.
  double gap() const;
  /// [K], at the last snapshot, of what is laid with the bead that it is laid on; infinity: it is laid on
  /// none, or the temperature of beads was not asked for.
  double interface_temperature() const;
  /// Number of beads under the nozzle's own path that count as contact by design: the first that is fresh.
  std::size_t fresh_from() const;
  bool flowing() const;  ///< in the last interval something left the nozzle
  DepositionSummary summary() const;
  const std::vector<UnsupportedStretch>& unsupported_stretches() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
