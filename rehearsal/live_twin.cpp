#include "rehearsal/live_twin.h"

#include <cmath>

#include "core/assert.h"
#include "core/error.h"
#include "rehearsal/observers/trace_observer.h"
#include "rehearsal/preparation.h"
#include "sim/collision/collision.h"
#include "sim/plant/plant.h"
#include "sim/sensors/microscope.h"
#include "sim/surface/beads_near.h"

namespace understudy::rehearsal {
namespace {

constexpr double kLaserSees = 6e-3;  // [m], around the tip, as in a rehearsal

TwinSetup prepared(const RehearsalRequest& request) {
  UNDERSTUDY_ASSERT(request.program.empty(), "a live twin runs no program");
  Mended mended;
  return prepare(request, mended);
}

}  // namespace

struct LiveTwin::Watch {
  explicit Watch(const TwinSetup& setup)
      : workpiece(std::make_shared<sim::Workpiece>(setup.built_part, setup.as_built.table)),
        deposition(setup.truth, workpiece),
        trace(deposition),
        collision(setup.truth, setup.as_built, setup.built_part, options()) {
    if (!setup.truth.has_microscope) return;
    sim::MicroscopeOptions view;
    view.table = setup.as_built.table;
    microscope.emplace(setup.truth, setup.built_part, setup.seed, view);
  }

  sim::CollisionOptions options() const {
    sim::CollisionOptions seen;
    seen.beads = &workpiece->beads();
    seen.fresh_from = [this] { return deposition.fresh_from(); };
    return seen;
  }

  std::shared_ptr<sim::Workpiece> workpiece;
  sim::DepositionObserver deposition;
  TraceObserver trace;
  sim::CollisionObserver collision;
  std::optional<sim::Microscope> microscope;
};

LiveTwin::LiveTwin(const RehearsalRequest& request)
    : setup_(prepared(request)),
      plant_(make_plant(setup_)),
      watch_(std::make_unique<Watch>(setup_)),
      owner_(std::this_thread::get_id()) {
  sim::TwinOptions options;
  options.faults = setup_.faults;
  options.camera_faults = setup_.camera_faults;
  options.seed = setup_.seed;
  options.nozzle_offset = setup_.as_built.nozzle_offset;
  options.load_encoders.emplace(setup_.truth, setup_.as_built,
                                machine::load_encoder_counts(setup_.machine.file.string()));
  const auto camera = [this](const sim::Shot& shot) { return expose(shot); };
  port_ = std::make_unique<sim::SimulatedPort>(
      setup_.machine, *plant_, watch_->microscope ? sim::Exposure(camera) : sim::Exposure(),
      std::vector<sim::Observer*>{&watch_->deposition, &watch_->trace, &watch_->collision}, options);
}

LiveTwin::~LiveTwin() = default;

Image LiveTwin::expose(const sim::Shot& shot) {
  UNDERSTUDY_ASSERT(std::this_thread::get_id() == owner_, "the microscope draws on the thread that made it");
  watch_->microscope->set_printed(
      sim::beads_near(watch_->workpiece->beads(), shot.X_WT.translation(), kLaserSees));
  return watch_->microscope->expose(shot);
}

void LiveTwin::check_engine() const {
  if (!port_->engine_failure().empty()) throw MachineError(port_->engine_failure());
}

Pose LiveTwin::true_pose() const { return plant_->tool_pose(); }

std::optional<double> LiveTwin::true_gap() const {
  const auto below = watch_->workpiece->below(plant_->tool_pose(), watch_->deposition.fresh_from());
  return below ? std::optional(below->distance) : std::nullopt;
}

std::vector<TracePoint> LiveTwin::trace() const {
  TraceObserver copy = watch_->trace;  // the observer goes on
  return copy.take();
}

sim::DepositionSummary LiveTwin::deposition() const { return watch_->deposition.summary(); }

std::optional<double> LiveTwin::least_clearance() const {
  const double clearance = watch_->collision.min_nozzle_clearance();
  return std::isfinite(clearance) ? std::optional(clearance) : std::nullopt;
}

}  // namespace understudy::rehearsal
