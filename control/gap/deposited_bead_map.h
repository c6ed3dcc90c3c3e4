// What a program has laid by a place of it. The dot runs beside the nozzle: it shows what is printed on only
// where no bead of the same layer lies, and above the first layer where the layer below does.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "control/gap/gap_reading.h"
#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::control {

class DepositedBeadMap {
 public:
  DepositedBeadMap() = default;
  /// Beads are as wide as their filament fills at the machine's aimed gap, their ends as the program has
  /// them.
  DepositedBeadMap(const toolpath::Program& program, const machine::MachineDescription& machine);

  /// A place on the surface, as programmed.
  struct Place {
    Vec3 p_W{0, 0, 0};
    Vec3 up_W{0, 0, 1};  ///< along the tool axis; unit
    double height = 0;   ///< [m], of the tip's path over the surface: the layer
  };
  /// Whether a dot of `radius` [m] shows what the tool prints on, when it is at `tip_W` in `line`. Does not
  /// allocate.
  bool shows_ground(const Place& place, double radius, int line, const Vec3& tip_W) const;

 private:
  /// Whether a bead so many layers below the path passes within `margin` [m] of its side.
  bool covers(const Place& place, int layers_below, double margin, int line, const Vec3& tip_W) const;
  struct Bead {
    Vec3 from_W, to_W;
    double half_width;  // [m]
    int line;
  };
  using Cell = std::pair<std::uint64_t, std::uint32_t>;  // key, number of the bead

  std::span<const Bead> of_line(int line) const;
  std::span<const Cell> in_cell(std::uint64_t key) const;

  std::vector<Bead> beads_;  // in the program's order
  std::vector<Cell> cells_;  // sorted
  double layer_ = 0;         // [m]
  double widest_ = 0;        // [m], half
};

/// Whether the dot of a tool that the program has at X_WT, `height` [m] above `surface`, shows what it prints
/// on.
bool dot_on_ground(const machine::MachineDescription& machine, const LocalSurface& surface,
                   const DepositedBeadMap& laid, const Pose& X_WT, double height, int line);

}  // namespace understudy::control
