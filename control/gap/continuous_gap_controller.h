// The gap watched while it is printed: frames are taken as the queue plays out, read with the surface below
// the pose in the middle of their exposure, and the setpoints to come are shifted along the tool axis.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "control/gap/deposited_bead_map.h"
#include "control/gap/gap_follower.h"
#include "control/gap/gap_sensor.h"
#include "control/setpoint_streamer.h"

namespace understudy::geometry {
class Mesh;
}

namespace understudy::control {

/// What was seen along the path and what became of it.
struct GapFollowing {
  GapStop stop = GapStop::none;
  std::string why;               ///< one line for the operator
  int line = 0;                  ///< where it stopped
  double time = 0;               ///< [s]
  double gap = 0;                ///< [m], last estimate
  double sigma = 0;              ///< [m]
  int frames = 0;                ///< taken
  int used = 0;                  ///< followed
  std::vector<GapSample> looks;  ///< every one; of the pictures some 40 are kept, evenly
};

class ContinuousGapController : public SetpointFilter {
 public:
  /// From a time on, every pose is shifted by this, in addition to what came before.
  using Report = std::function<void(double time, int line, const Vec3& offset_W)>;

  /// `part` may be null: the surface is flat and perpendicular to the tool. `laid` outlives the watch.
  ContinuousGapController(const machine::MachineDescription& machine, const geometry::Mesh* part,
                          const DepositedBeadMap& laid, const GapControllerOptions& approach,
                          const GapFollowerOptions& options, machine::MachinePort& port, Report report);
  ~ContinuousGapController() override;

  /// Follows from here: `offset_W` is what the poses pushed from now on carry beyond the program's.
  void start(const Vec3& offset_W, double gap, double sigma);
  void start_unknown(const Vec3& offset_W);
  /// Ends it; the correction that stands [m], along the tool axis, is no longer added to what follows.
  double release();
  bool active() const { return active_; }
  /// The filament fed by a time of the last half second [m].
  double filament_at(double time) const;

  double lead() const override;
  machine::Status pass_time(double until) override;
  bool shift(const PlannedPoint& point, machine::Setpoint& ready) override;
  bool flush(machine::Setpoint& ready) override;
  GapStop stop() const override { return active_ ? following_.stop : GapStop::none; }

  GapFollowing& following() { return following_; }

 private:
  struct Passed {
    double time = 0, path = 0, correction = 0, filament = 0;
    Pose X_WT = Pose::Identity();  ///< pushed, before the correction
    bool printing = false;
    int line = 0;
  };
  const Passed& passed(std::size_t back) const {
    return ring_[(head_ + ring_.size() - 1 - back) % ring_.size()];
  }
  bool passed_at(double time, Passed& at) const;
  void remember(const PlannedPoint& point);
  bool axes_shift(const PlannedPoint& point, double correction, kinematics::AxisVector& shift);
  bool find_surface(const Passed& at);
  machine::Status look(const Passed& expected);
  GapStop read(const Passed& expected, GapSample& look, Passed& at);
  void judge(GapSample& look, GapStop seen, const Passed& at);
  double still_reading(const vision::DotMeasurement& dot);
  void keep(GapSample look);
  void raise_stop(GapStop reason, std::string why, const Passed& at);
  void raise_follower_stop(const GapSample& look, const Passed& at);

  const machine::MachineDescription& machine_;
  const geometry::Mesh* part_;
  const DepositedBeadMap& laid_;
  GapFollowerOptions options_;
  machine::MachinePort& port_;
  Report report_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  LocalSurface surface_;
  GapSensor eye_;
  GapFollower follower_;
  GapFollowing following_;
  bool active_ = false, measurable_ = false;
  Vec3 offset_W_{0, 0, 0};
  double height_at_start_ = 0;  // [m], programmed over the nominal part
  bool height_known_ = false;
  std::optional<vision::DotMeasurement> still_dot_;  // of an earlier look of this bead

  std::vector<Passed> ring_;
  std::size_t head_ = 0, filled_ = 0;
  machine::Setpoint held_;  // complete when the next one's shift is known
  bool holding_ = false;
  kinematics::AxisVector shift_before_{}, shift_held_{};
  double time_before_ = 0;
  double correction_ = 0;
  double reported_at_ = 0;
  Vec3 reported_W_{0, 0, 0};
  std::vector<kinematics::LimitViolation> violations_;
  int picture_stride_ = 1;
};

}  // namespace understudy::control
