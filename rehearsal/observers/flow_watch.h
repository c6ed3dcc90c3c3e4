// Where the beads are thinner or thicker than the program asks for.
#pragma once

#include <vector>

#include "machine/description.h"
#include "sim/deposition/deposition.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// Consecutive elements whose cross-section is off the programmed one by more than kFlowTolerance.
struct FlowStretch {
  int line = 0;     ///< where it begins
  double time = 0;  ///< [s], there
  Vec3 place_W{0, 0, 0};
  double length = 0;  ///< [m]
  double ratio = 1;   ///< laid over programmed cross-section, the farthest from 1
  double amount = 0;  ///< [m], too much (> 0) or too little, as length of the programmed bead
};

constexpr double kFlowTolerance = 0.2;
/// [m]: a shorter stretch is a start, an end or a corner, unless as much bead as this is missing or too much.
constexpr double kFlowLength = 1e-3;

class FlowWatch {
 public:
  FlowWatch(const toolpath::Program& program, const machine::MachineDescription& machine);
  void add(const sim::LaidBead& bead);
  /// Those where length or amount is at least kFlowLength.
  std::vector<FlowStretch> stretches() const;

 private:
  void end();

  std::vector<float> areas_;  // [m^2] by line; 0: nothing programmed
  std::vector<FlowStretch> stretches_;
  FlowStretch open_;
  bool is_open_ = false;
};

}  // namespace understudy::rehearsal
