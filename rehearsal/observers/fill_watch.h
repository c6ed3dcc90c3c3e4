// How well neighbouring lines of a layer fill the space between them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "machine/description.h"
#include "sim/deposition/deposition.h"
#include "sim/deposition/workpiece.h"

namespace understudy::rehearsal {

struct FillFigures {
  /// Cross-section of two neighbours over the space from the middle of one to the middle of the other: 1
  /// where a slicer plans no voids. The 90th percentile by length, so that sparse infill does not count as
  /// voids.
  double factor = 1;
  double length = 0;  ///< [m] of lines with a neighbour
  int line = 0;       ///< of the program, the first that is filled no better
  double time = 0;    ///< [s], there
  Vec3 place_W{0, 0, 0};
};

/// Looks to both sides of every bead for one of the same layer that runs alongside, no farther than 1.5 bores
/// from middle to middle: lines so near are meant to touch, for slicers plan them a bore to one and a half
/// wide.
class FillWatch {
 public:
  FillWatch(std::shared_ptr<const sim::Workpiece> workpiece, const machine::MachineDescription& machine)
      : workpiece_(std::move(workpiece)), reach_(kNeighbours * machine.tool.nozzle_diameter) {}
  /// Beads in order, each after it has joined the workpiece; `before`: the first that is fresh.
  void add(const sim::LaidBead& bead, std::size_t before);
  /// Nothing where fewer than 100 mm of lines have a neighbour.
  std::optional<FillFigures> figures() const;

 private:
  static constexpr double kNeighbours = 1.5;
  struct Sample {
    float factor = 0, length = 0, time = 0;
    int line = 0;
    Vec3 place_W{0, 0, 0};
  };
  void look(const sim::LaidBead& bead, const Vec3& aside_W, std::size_t before);

  std::shared_ptr<const sim::Workpiece> workpiece_;
  double reach_;  // [m]
  std::vector<Sample> samples_;
};

}  // namespace understudy::rehearsal
