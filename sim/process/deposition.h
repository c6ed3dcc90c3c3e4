// Beads laid where the true tip went, with the true gap (Song 2015, 3.3: above 0.2 mm nothing sticks).
#pragma once

#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/observer.h"

namespace understudy::sim {

/// True gap along the tool axis: from the tip to the part or the table, negative inside. Infinity where the
/// axis meets neither within 50 mm.
double true_gap(const geometry::Mesh* part, const Pose& X_WT);

struct Bead {
  Vec3 from_W, to_W;       ///< [m], on the surface below the tip
  Vec3 normal_W;           ///< tool axis
  double gap = 0;          ///< [m], at its end
  double width = 0;        ///< [m], from conserved volume at this gap
  double volume = 0;       ///< [m^3]
  bool sticks = false;
  double time = 0;
  int line = 0;
};

struct DepositionSummary {
  double length = 0;             ///< [m] of path while extruding
  double in_band_fraction = 0;   ///< of that length with the gap in the accepted band
  double gap_min = 0, gap_mean = 0, gap_max = 0;   ///< [m], weighted by length
  double start_gap = 0;          ///< [m], true gap where extrusion began first
  double extruded_volume = 0;    ///< [m^3]
  double deposited_volume = 0;   ///< [m^3], of beads that stick
};

class DepositionObserver : public Observer {
 public:
  DepositionObserver(const machine::MachineDescription& machine, std::shared_ptr<const geometry::Mesh> part);
  ~DepositionObserver() override;
  void observe(const Snapshot& snapshot) override;

  const std::vector<Bead>& beads() const;
  DepositionSummary summary() const;
  /// Stretches of consecutive beads that do not stick.
  struct Loose { int line; double time; double length; double worst_gap; Vec3 place_W; };
  std::vector<Loose> loose_stretches() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
