// Private to the gap benchmark: a surface, what disturbs the picture, and a machine that errs, brought
// together.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/gap/gap_sensor.h"
#include "control/print.h"
#include "core/random.h"
#include "machine/loopback_port.h"
#include "sim/sensors/microscope.h"

namespace understudy::studies {

struct GapSurface {
  std::string name;
  std::shared_ptr<const geometry::Mesh> part;
  toolpath::Program program;  ///< S', S, a bead, up
  Pose X_WT_S = Pose::Identity();
};

enum class FrameFault { none, occluded, ghost, stale, lost };

struct GapCondition {
  std::string name;
  bool benign = true;
  bool speckle = true;
  double light = 1;    ///< of the laser's nominal brightness
  double ambient = 1;  ///< of the nominal grey levels around the dot
  FrameFault mischief = FrameFault::none;
  bool of_detectors = true;  ///< of one picture; the others need several
};

constexpr double kBenchBead = 6e-3;  ///< [m], on the plates

/// Plates that lean by 0, 10, 20 and 30 degrees, with a bead of `bead` [m], and the bottle with its program.
std::vector<GapSurface> gap_surfaces(const machine::MachineDescription& machine, const std::string& program,
                                     double bead = kBenchBead);

/// Up to the last approach, and the shortest of beads: for a trial of approaches alone.
toolpath::Program until_bead(const toolpath::Program& program);

const std::vector<GapCondition>& gap_conditions();

/// From when on the condition holds; before, the light is good.
enum class Since { always, bead };

/// The microscope of one surface and condition. Use from the thread that made it.
class GapScene {
 public:
  GapScene(const machine::MachineDescription& machine, const GapSurface& surface,
           const GapCondition& condition, Since since, std::uint64_t seed);

  /// Empty: the frame is lost.
  Image expose(const Pose& X_WT_true, const Region& region, bool printing = false);
  double true_gap(const Pose& X_WT_true) const;
  int repeats(bool printing);  ///< so many of the next frames are the last one again

  const GapSurface& surface;
  const GapCondition& condition;

 private:
  bool disturbed(bool printing) const { return since_ == Since::always || printing; }
  void occlude(Image& image) const;
  void glow(Image& image);

  Since since_;
  machine::MachineDescription lit_;
  sim::Microscope microscope_;
  std::optional<sim::Microscope> calm_;  // the same part in good light
  Random random_;
  std::uint64_t frame_ = 0;
};

/// One print on a machine whose tip is off by an error that changes along the path.
struct GapTrial {
  control::PrintResult result;
  std::vector<double> bead_gaps_mm;  ///< true, every few cycles of the bead
  double gap_min_mm = 0;             ///< true, over all of it
  double last_gap_mm = 0;
};
GapTrial run_gap_trial(const machine::MachineDescription& machine, GapScene& scene, control::GapControl mode,
                       std::uint64_t seed);

}  // namespace understudy::studies
