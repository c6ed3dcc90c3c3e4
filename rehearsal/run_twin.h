// One print on the twin with all its observers: the raw material of a rehearsal.
#pragma once

#include <memory>
#include <vector>

#include "control/print.h"
#include "core/progress.h"
#include "geometry/mesh.h"
#include "machine/accepted_errors.h"
#include "machine/calibrated_parameters.h"
#include "machine/cure.h"
#include "machine/description.h"
#include "machine/material.h"
#include "rehearsal/observers/curves_observer.h"
#include "rehearsal/observers/fill_watch.h"
#include "rehearsal/observers/flow_watch.h"
#include "rehearsal/observers/trace_observer.h"
#include "rehearsal/program/programmed_layers.h"
#include "rehearsal/record.h"
#include "rehearsal/registration.h"
#include "rehearsal/run_listener.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/collision.h"
#include "sim/deposition/deposition.h"
#include "sim/faults/camera_faults.h"
#include "sim/faults/faults.h"
#include "sim/removal/removal_summary.h"
#include "sim/strand/air_strands.h"
#include "toolpath/gcode/rewrite/rewritten_path.h"
#include "toolpath/program.h"

namespace understudy::sim {
class Plant;
struct MilledSurface;
struct Workblank;
}  // namespace understudy::sim

namespace understudy::rehearsal {

/// What a run reads; immutable, shared by runs in several threads.
struct TwinSetup {
  machine::MachineDescription machine;       ///< what the controller holds
  machine::CalibratedParameters calibrated;  ///< of the same file: how sure its geometry is
  machine::MachineDescription truth;  ///< sim::true_description(machine, as_built): what the twin holds
  machine::Material material;         ///< of a tool that prints
  machine::AcceptedErrors accepted;
  toolpath::Program program;
  /// Where a program asked for the tool that `program` was compensated from; null: `program` itself asks.
  std::shared_ptr<const toolpath::RewrittenPath> asked;
  std::shared_ptr<const ProgrammedLayers> layers;  ///< of the program; null: the machine's band is good
  std::shared_ptr<const geometry::Mesh> part;      ///< as drawn: what the controller holds; may be null
  std::shared_ptr<const geometry::Mesh>
      built_part;                                   ///< as clamped: what the twin holds; null where `part` is
  std::shared_ptr<const sim::Workblank> workblank;  ///< of a mill; null: what it cuts is not asked for
  std::optional<machine::Cure> cure;                ///< of a tool that cures resin
  sim::AsBuilt as_built;
  std::string engine;
  std::uint64_t seed = 0;
  double timestep = 0;  ///< [s], of the plant; 0: the engine's own
  std::vector<sim::FaultEvent> faults;
  std::vector<sim::CameraFaultEvent> camera_faults;
  std::optional<control::RegistrationTask> registration;  ///< before the print
};

struct TwinRun {
  std::optional<RegistrationRun> registration;
  control::PrintResult result;
  std::vector<TracePoint> trace;
  int trace_stride = 1;  ///< snapshots a point of the trace
  RunCurves curves;
  std::optional<AccuracyFigures> accuracy;
  ErrorPeak tip_peak, orientation_peak;
  std::vector<FrameRecord> frames;
  std::vector<sim::Contact> collisions, near_collisions;
  CollisionFigures collision;
  int altered_frames = 0;  ///< by the camera's faults (sim::FaultyCamera)
  sim::DepositionSummary deposition;
  std::vector<sim::UnsupportedStretch> loose;
  std::vector<FlowStretch> flow;
  std::optional<FillFigures> fill;
  std::vector<sim::AirStrand> strands;
  std::shared_ptr<sim::Workpiece> workpiece;  ///< as printed
  std::optional<sim::RemovalSummary> removal;
  std::shared_ptr<const sim::MilledSurface> milled;
  EngineFigures engine;
  TimingFigures timing;
};

struct RunOptions {
  control::GapControl gap_control = control::GapControl::start;
  bool watch_collisions = true;
  /// The program breaks limits of axes or joints: an axis stays at the end of its range, a joint goes on.
  bool beyond_limits = false;
  std::string record;  ///< file of what goes through the port (docs/port-record.md); empty: none
  RunListener* listener = nullptr;
};

/// Words of `--engine` and of scenarios.
const std::vector<std::string>& engine_names();

/// The true machine in the engine that was asked for, with the errors of its drives.
std::unique_ptr<sim::Plant> make_plant(const TwinSetup& setup);

/// Throws MachineError when the engine fails, Interrupted.
TwinRun run_twin(const TwinSetup& setup, const RunOptions& options, const Progress& progress);

}  // namespace understudy::rehearsal
