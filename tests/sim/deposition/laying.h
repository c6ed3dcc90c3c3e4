// A deposition observer with its workpiece and what it laid.
#pragma once

#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "sim/deposition/deposition.h"

namespace understudy::sim {

constexpr double kFilament = 1.75e-3;
inline const double kFilamentArea = std::numbers::pi / 4 * kFilament * kFilament;

/// An extruder without lag.
inline machine::MachineDescription printer() {
  machine::MachineDescription machine;
  machine.tool.nozzle_diameter = 0.4e-3;
  machine.tool.flat_diameter = 1e-3;
  machine.tool.filament_diameter = kFilament;
  machine.process.extruder_lag = 0;
  machine.gap.accepted_min = 0.1e-3;
  machine.gap.accepted_max = 0.2e-3;
  machine.gap.aim = 0.15e-3;
  return machine;
}

inline Snapshot at(double time, const Vec3& tip, double filament, int line = 1,
                   const Mat3& R = Mat3::Identity()) {
  Snapshot s;
  s.time = time;
  s.X_WT = make_pose(R, tip);
  s.filament = filament;
  s.line = line;
  return s;
}

class Laying {
 public:
  explicit Laying(const machine::MachineDescription& machine,
                  std::shared_ptr<const geometry::Mesh> insert = nullptr, DepositionOptions options = {})
      : workpiece_(std::make_shared<Workpiece>(std::move(insert))),
        observer_(machine, workpiece_, with_sink(std::move(options))) {}
  Laying(const Laying&) = delete;
  Laying& operator=(const Laying&) = delete;

  void observe(const Snapshot& snapshot) { observer_.observe(snapshot); }
  /// `count` equal intervals of one second in all.
  template <typename Motion>
  void run(int count, const Motion& motion) {
    for (int i = 0; i <= count; ++i) observe(motion(static_cast<double>(i) / count));
  }

  // All of these as if the print ended here.
  const std::vector<LaidBead>& beads() { return observer_.finish(), beads_; }
  DepositionSummary summary() { return observer_.finish(), observer_.summary(); }
  const std::vector<UnsupportedStretch>& unsupported_stretches() {
    return observer_.finish(), observer_.unsupported_stretches();
  }
  double total_volume() {
    double sum = 0;
    for (const LaidBead& bead : beads()) sum += bead.volume;
    return sum;
  }
  Workpiece& workpiece() { return *workpiece_; }
  DepositionObserver& observer() { return observer_; }

 private:
  DepositionOptions with_sink(DepositionOptions options) {
    options.laid = [this](const LaidBead& bead) { beads_.push_back(bead); };
    return options;
  }

  std::shared_ptr<Workpiece> workpiece_;
  std::vector<LaidBead> beads_;
  DepositionObserver observer_;
};

}  // namespace understudy::sim
