// The print loop: one for the twin and for the machine (docs/life-of-one-move.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/gap/continuous_gap_controller.h"
#include "control/gap/gap_controller.h"
#include "control/motion/motion_limits.h"
#include "control/stop.h"
#include "toolpath/program.h"

namespace understudy::control {

enum class GapControl {
  off,
  start,       ///< closed before each bead, the offset carried along it
  continuous,  ///< and measured and corrected along it (docs/gap-control.md)
};

struct PrintOptions {
  GapControl gap_control = GapControl::start;
  /// A port that holds its axes within their ranges may be given a program that breaks limits.
  PoseCheck poses = PoseCheck::limits;
  std::optional<GapControllerOptions> gap;      ///< nothing: gap_controller_options() of the machine
  std::optional<GapFollowerOptions> following;  ///< nothing: gap_follower_options() of the machine
  /// The nominal part in the program's frame, for the dot's geometry; without it the surface is taken as
  /// flat and perpendicular to the tool at S.
  const geometry::Mesh* part = nullptr;
  Vec3 offset_W{0, 0, 0};  ///< [m], of the program until the first approach: a print that was interrupted
};

struct GapApproach {
  int line = 0;        ///< of the move that ends at S
  double done_at = 0;  ///< [s]
  GapOutcome outcome;
};

struct PrintResult {
  bool completed = false;
  Stop stop;            ///< why it ended early
  double duration = 0;  ///< [s], port clock
  int moves = 0;
  double extruded = 0;  ///< [m] of filament fed; what a retraction took back is not counted twice
  double primed = 0;    ///< [m], pushed back to the nozzle after retractions
  double travel = 0;    ///< [m] of tip path without extrusion
  std::vector<OffsetChange> offsets;
  std::vector<GapApproach> approaches;
  /// Lines of approaches where the dot would lie on a bead beside, or off the layer below: the offset of the
  /// bead before is carried on.
  std::vector<int> unmeasured_starts;
  std::optional<GapFollowing> following;  ///< with GapControl::continuous

  /// By the gap controller, and not in an approach.
  bool stopped_on_path() const {
    return stop.gap != GapStop::none &&
           (approaches.empty() || approaches.back().outcome.stop == GapStop::none);
  }
};

class PrintObserver {
 public:
  virtual ~PrintObserver() = default;
  /// Called as steps are handed to the port; `done` of `total` steps.
  virtual void progress(std::size_t done, std::size_t total, double port_time) = 0;
  /// The gap controller shifts the program: called before anything moves by it. A gradual change is told
  /// while the machine still executes what lies before its time.
  virtual void offset_changed(const OffsetChange& change) { static_cast<void>(change); }
};

/// An approach is a step of kind `move` of at most 10 mm straight against the tool axis (within 1 degree)
/// that ends where the next `print` step begins. With GapControl::start each is closed by close_gap and the
/// offset carried to all later steps until the next approach (Song 2015, eq 5: points are relative); so it is
/// where the dot would not lie on what is printed on. With
/// GapControl::continuous the gap is then measured while print steps run, and the offset follows it.
/// A GapStop retreats, ends the print and is reported; nothing is printed without a known gap.
PrintResult print(const toolpath::Program& program, const machine::MachineDescription& machine,
                  machine::MachinePort& port, const PrintOptions& options, PrintObserver* observer = nullptr);

}  // namespace understudy::control
