// The gap controlled while it is printed: frames are taken as the queue plays out, read with the surface
// below the pose in the middle of their exposure, and the setpoints to come are shifted along the tool axis.
//
// In a control cycle (control/cycle.h) read() comes first, update() judges what was read, and shift() applies
// the correction to what is to be queued. update(), shift() and flush() neither allocate nor lock; the camera
// delivers frames that own their pixels, and record() keeps them for the report.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "control/gap/command_history.h"
#include "control/gap/deposited_bead_map.h"
#include "control/gap/gap_follower.h"
#include "control/gap/gap_sensor.h"
#include "control/gap/offset_change.h"
#include "control/gap/sensor_uncertainty.h"
#include "control/gap/setpoint_filter.h"
#include "geometry/mesh.h"

namespace understudy::control {

/// What was measured along the path and what became of it.
struct GapFollowing {
  double gap = 0;                  ///< [m], last estimate
  double sigma = 0;                ///< [m]
  int frames = 0;                  ///< taken
  int used = 0;                    ///< followed
  std::vector<GapSample> samples;  ///< every one; of the pictures some 40 are kept, evenly
};

/// What is printed, as the controller knows it.
struct PrintedPart {
  const geometry::Mesh* mesh = nullptr;  ///< nullptr: the surface is flat and perpendicular to the tool
  DepositedBeadMap beads;
};

struct ContinuousGapOptions {
  GapControllerOptions sensing;
  GapFollowerOptions following;
};

class ContinuousGapController {
 public:
  /// From a time on, every pose is shifted by this, in addition to what came before.
  using Report = std::function<void(const OffsetChange&)>;

  /// Machine, part and port outlive the controller. The mesh of the part is made ready (local_surface.h).
  ContinuousGapController(const machine::MachineDescription& machine, const PrintedPart& part,
                          const ContinuousGapOptions& options, machine::MachinePort& port, Report report);

  /// Follows from here: `offset_W` is what the poses pushed from now on carry beyond the program's.
  void start(const Vec3& offset_W, double gap, double sigma);
  void start_unknown(const Vec3& offset_W);
  /// Ends it; the correction that stands [m], along the tool axis, is no longer added to what follows.
  double release();
  bool active() const { return active_; }
  /// The filament fed by a time of the last half second [m].
  double filament_at(double time) const;

  /// [s] of motion that the queue holds: what is queued stays as it is.
  double lead() const;

  /// Takes the frame that is due, or lets the port's clock run to about `until`; never to the queue's end.
  machine::Status read(double until);
  /// Takes the frame's reading into the estimate.
  void update();
  /// Takes a planned point and hands out the one before, shifted. False: there is none yet.
  bool shift(const PlannedPoint& point, machine::Setpoint& ready);
  bool flush(machine::Setpoint& ready) { return filter_.flush(ready); }  ///< the last one of a stretch
  /// Keeps what the last cycle has seen and decided, and reports it.
  void record();

  /// Why the print must stop; none: it need not. Stays.
  GapStop stop() const { return active_ ? stop_ : GapStop::none; }
  /// The same in words, and where: to be asked before the next record().
  struct StopCause {
    std::string why;  ///< one line for the operator
    int line = 0;
    double time = 0;  ///< [s]
  };
  StopCause stop_cause() const;

  GapFollowing& following() { return following_; }

 private:
  struct Reading {  ///< the last frame and what was made of it
    bool fresh = false, judged = false;
    GapStop seen = GapStop::none;
    GapVerdict verdict = GapVerdict::used;
    Commanded at;         ///< in the middle of its exposure
    double expected = 0;  ///< [m], gap
    double taken_at = 0;  ///< [s]
    GapSample sample;
  };

  bool find_surface(const Commanded& at);
  machine::Status take_frame(const Commanded& expected);
  GapStop sense(const Commanded& expected);
  void judge();
  void note_belief();
  double still_reading(const vision::DotMeasurement& dot);
  void remember(const PlannedPoint& point);
  void note_offset(const PlannedPoint& point);
  void raise(GapStop reason, const Commanded& at, double time);
  std::string why_unused() const;
  std::string why_follower_stopped() const;
  void keep(GapSample sample);

  const machine::MachineDescription& machine_;
  const PrintedPart& part_;
  const ContinuousGapOptions options_;
  machine::MachinePort& port_;
  Report report_;
  LocalSurface surface_;
  SafeAim safe_;  // of the last frame
  GapSensor sensor_;
  GapFollower follower_;
  GapFollowing following_;
  CommandHistory history_;
  SetpointFilter filter_;
  bool active_ = false, measurable_ = false;
  Vec3 offset_W_{0, 0, 0};
  double height_at_start_ = 0;  // [m], programmed over the nominal part
  bool height_known_ = false;
  std::optional<vision::DotMeasurement> still_dot_;  // of an earlier frame of this bead
  Reading reading_;
  double correction_ = 0;  // [m]
  GapStop stop_ = GapStop::none;
  Commanded stopped_;     // where
  double stop_time_ = 0;  // [s]

  double reported_at_ = 0;
  Vec3 reported_W_{0, 0, 0};
  std::vector<OffsetChange> offsets_;  // decided and not yet reported
  int picture_stride_ = 1;
};

}  // namespace understudy::control
