// How well neighbouring lines of a layer fill the space between them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "machine/description.h"
#include "rehearsal/observers/thinned_series.h"
#include "sim/deposition/deposition.h"
#include "sim/deposition/workpiece.h"

namespace understudy::rehearsal {

/// Cross-section of two neighbours over the space from the middle of one to the middle of the other: 1 where
/// a slicer plans no voids. Medians by length: half of the lines are filled no better.
struct FillFigures {
  /// By what the drive feeds for each line. An extruder's lag moves material along the lines, and takes none
  /// away.
  double factor = 1;
  double laid = 1;    ///< by the beads as they lie, which the lag makes thin here and thick there
  double length = 0;  ///< [m] of lines with a neighbour
  int line = 0;       ///< of the program, the first that is filled no better
  double time = 0;    ///< [s], there
  Vec3 place_W{0, 0, 0};
};

/// Looks to both sides of every bead for one of the same layer that runs alongside, no farther than 1.5 bores
/// from middle to middle: lines so near are meant to touch, for slicers plan them a bore to one and a half
/// wide. What fills sparsely lies farther apart, and does not count as voids.
class FillWatch {
 public:
  /// `fed`: [m^2] of bead by line of the file, of the filament that is really there (programmed_areas()).
  FillWatch(std::shared_ptr<const sim::Workpiece> workpiece, const machine::MachineDescription& machine,
            std::vector<float> fed)
      : workpiece_(std::move(workpiece)),
        fed_(std::move(fed)),
        reach_(kNeighbours * machine.tool.nozzle_diameter) {}
  /// Beads in order, each after it has joined the workpiece; `before`: the first that is fresh.
  void add(const sim::LaidBead& bead, std::size_t before);
  /// Nothing where fewer than 100 mm of lines have a neighbour.
  std::optional<FillFigures> figures() const;

 private:
  static constexpr double kNeighbours = 1.5;
  static constexpr std::size_t kSamplesMost = 400'000;
  /// Evenly of all that were looked at, where those are more. What the bead itself knows is asked of it.
  struct Sample {
    float fed = 0, laid = 0, length = 0;
    std::uint32_t bead = 0;                             ///< of the workpiece
    Eigen::Vector3f place_W = Eigen::Vector3f::Zero();  ///< [m]
  };
  void look(const sim::LaidBead& bead, const Vec3& aside_W, std::size_t before);
  double fed_on(int line) const;
  /// Of the samples in order of that factor, the one that half of the length does not exceed.
  const Sample& median(float Sample::*factor) const;

  std::shared_ptr<const sim::Workpiece> workpiece_;
  std::vector<float> fed_;  // [m^2] by line
  double reach_;            // [m]
  double length_ = 0;       // [m]
  ThinnedSeries<Sample> samples_{kSamplesMost};
};

}  // namespace understudy::rehearsal
