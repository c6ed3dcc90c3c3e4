// Beads laid where the true tip went, with the true gap (Song 2015, 3.3: above 0.2 mm nothing sticks).
#pragma once

#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/observer.h"

namespace understudy::sim {

constexpr double kGapReach = 50e-3;  ///< [m], below the tip: beyond it there is nothing to print on

/// True gap along the tool axis: from the tip to the part or the table (the plane z = 0 of W), negative
/// inside. Infinity where the axis meets neither within kGapReach. A roof of the part above the tip is no surface
/// to print on and does not count.
double true_gap(const geometry::Mesh* part, const Pose& X_WT);

/// Width of a bead of this cross-section [m^2] pressed to the height `gap`: flat with rounded edges, area =
/// (w - g) g + pi g^2 / 4; a round strand where it is too thin to touch both sides, or the gap is not above
/// 0.
double bead_width(double area, double gap);

/// An element of at least 0.1 mm of path, shorter only where extrusion pauses or the state of sticking
/// changes. Filament fed at a standstill belongs to the element that goes on from there; where the tip leaves
/// instead, it stays behind as an element without length.
struct Bead {
  Vec3 from_W{0, 0, 0};  ///< [m], on the surface below the tip; the tip itself where there is none
  Vec3 to_W{0, 0, 0};
  Vec3 normal_W{0, 0, 1};  ///< tool axis
  double length = 0;       ///< [m] of path on the surface
  double gap = 0;          ///< [m], mean over the element
  double width = 0;        ///< [m], from conserved volume at this gap
  double volume = 0;       ///< [m^3]
  bool sticks = false;     ///< 0 < gap <= accepted_max
  double time = 0;         ///< [s], at its end
  int line = 0;            ///< at its end
};

struct DepositionSummary {
  double length = 0;            ///< [m] of path on the surface while extruding
  double in_band_fraction = 0;  ///< of that length with the gap in the accepted band
  double below_band_fraction = 0, above_band_fraction = 0;  ///< the rest
  double gap_min = 0, gap_mean = 0, gap_max = 0;  ///< [m], weighted by length, where a surface is below
  double start_gap = 0;                           ///< [m], true gap where extrusion began first
  double extruded_volume = 0;   ///< [m^3], net: what a retraction took back is not counted twice
  double deposited_volume = 0;  ///< [m^3], of beads that stick
};

/// Between snapshots tip, gap and feed are taken as linear, so that fractions and the ends of loose stretches
/// do not depend on the snapshots' rate where the true motion is.
class DepositionObserver : public Observer {
 public:
  DepositionObserver(const machine::MachineDescription& machine, std::shared_ptr<const geometry::Mesh> part);
  ~DepositionObserver() override;
  void observe(const Snapshot& snapshot) override;

  const std::vector<Bead>& beads() const;
  DepositionSummary summary() const;
  /// Stretches of consecutive beads that do not stick, for the same reason: too high, or the nozzle at or
  /// below the surface. Line, time and place are where it begins; the gap is the farthest from the band.
  struct Loose {
    int line;
    double time;
    double length;
    double worst_gap;
    Vec3 place_W;
  };
  std::vector<Loose> loose_stretches() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
