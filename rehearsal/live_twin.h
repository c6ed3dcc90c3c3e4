// The twin as a port that somebody else drives: no program, no controller of ours. It is built as that of a
// rehearsal is, and watched by the same observers.
#pragma once

#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "rehearsal/record.h"
#include "rehearsal/request/request.h"
#include "rehearsal/run_twin.h"
#include "sim/deposition/deposition.h"
#include "sim/twin/simulated_port.h"

namespace understudy::rehearsal {

/// Use from the thread that made it: the microscope draws there.
class LiveTwin {
 public:
  /// `request` without a program. Throws InputError as a rehearsal does, MachineError where the engine cannot
  /// stand the machine at home.
  explicit LiveTwin(const RehearsalRequest& request);
  ~LiveTwin();

  const TwinSetup& setup() const { return setup_; }  ///< `machine`, `part`: what a controller may know
  sim::SimulatedPort& port() { return *port_; }
  /// Throws MachineError where the engine has failed: nothing of such a run is a result.
  void check_engine() const;

  // The truth, for judges only.
  Pose true_pose() const;                  ///< X_WT
  std::optional<double> true_gap() const;  ///< [m], along the tool axis; nothing where nothing lies below
  std::vector<TracePoint> trace() const;   ///< of all that has happened
  sim::DepositionSummary deposition() const;
  /// [m], of the nozzle to all that it may touch, negative inside; nothing where there is nothing.
  std::optional<double> least_clearance() const;

 private:
  struct Watch;
  Image expose(const sim::Shot& shot);

  TwinSetup setup_;
  std::unique_ptr<sim::Plant> plant_;
  std::unique_ptr<Watch> watch_;
  std::unique_ptr<sim::SimulatedPort> port_;
  std::thread::id owner_;
};

}  // namespace understudy::rehearsal
