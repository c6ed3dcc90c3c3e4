// Follows the gap along the path: from readings that come late and scatter to a correction along the tool
// axis. What is estimated is the gap that there would be without any correction, as a line over the path: a
// reading, less the correction that was in force in the middle of its exposure, does not depend on what was
// decided since (a Smith predictor), and the line gives the gap where the next setpoint will be.
//
// Speckle is averaged by a Kalman filter whose noise is that of the readings. What jumps is not followed: a
// fresh bead or an edge lifts the reading by more than its noise explains. What does not move when the
// correction does is not believed for long (control/gap/gap_response.h), and is asked by a deliberate motion
// (control/gap/gap_excitation.h). Nothing here allocates or throws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/gap/confidence.h"
#include "control/gap/frame_outcomes.h"
#include "control/gap/gap_controller.h"
#include "control/gap/gap_excitation.h"
#include "control/gap/gap_line.h"
#include "control/gap/gap_response.h"
#include "control/gap/lasting_step.h"

namespace understudy::control {

/// Gains and limits, by default those of a machine file that does not say.
struct GapFollowerOptions : machine::GapFollowingSettings {
  double aim = 0;  ///< [m], gap along the path
  /// [m], of the correction towards the part until readings show that they follow it: a spot that stands
  /// still in the picture leads no farther.
  double unproved_max = 40e-6;
  GapLineOptions line;
  double speckle_length = 0.15e-3;  ///< [m] of path after which speckle is new
  double step_max = 50e-6;          ///< [m], a lasting step of the machine; a bead is at least twice as high
  double floor = 50e-6;             ///< [m], the gap less three sigma must stay above this
  /// [m], how far the tool rises to see whether readings follow it; 0: never.
  double excitation = 0;
};

/// For a machine: its gains and limits, its aim, its speckle, half of its smallest accepted gap as floor and
/// as the largest step, half of what lies between aim and floor as unproved travel, and a third of what the
/// band leaves above the aim as excitation.
GapFollowerOptions gap_follower_options(const machine::MachineDescription& machine);

/// One reading, brought together with what was commanded in the middle of its exposure.
struct GapObservation {
  double time = 0;        ///< [s], middle of the exposure
  double path = 0;        ///< [m], travelled by then; turns count
  double correction = 0;  ///< [m], in force then
  double gap = 0;         ///< [m], as read
  double sigma = 0;       ///< [m]
  /// [m], what a spot that stands still in the picture would read here, up to a constant; NaN: it begins anew
  double still = 0;
  double excitation = 0;  ///< [m], the deliberate part of `correction`
};

enum class GapVerdict { used, jump, repeated, not_yet };

class GapFollower {
 public:
  static constexpr int kMixedReadings = 24;

  struct Correction {
    double value = 0;       ///< [m], along the tool axis, positive away from the part
    double rate = 0;        ///< [m/s]
    double excitation = 0;  ///< [m], the deliberate part of `value`
  };

  explicit GapFollower(const GapFollowerOptions& options);

  /// The gap is known, as after an approach: the correction begins at 0 from here.
  void start(double time, double path, double gap, double sigma);
  /// Nothing is known: `step_samples` readings that agree begin it; the correction stays at 0 until then.
  void start_unknown(double time, double path);
  /// Readings begin again after a part of the path where there could be none.
  void resume(double time, double path);

  /// Where the next reading lies: what to aim at, and what the sensor's calibration leaves of it [m], 1
  /// sigma, alike in all readings.
  void aim_at(double aim, double calibration_sigma);
  /// The sensor's calibration leaves too much for any aim.
  void give_up() { raise(GapStop::uncertain); }

  /// Time and path in which nothing was to be seen: the clock of stops stands still.
  void pass(double dt, double way);

  GapVerdict observe(const GapObservation& o);
  /// A frame without a reading, for a reason.
  void miss(double time, double path, GapStop why);

  /// The correction a cycle later, where the path will be then. `follow` false: it comes to rest.
  Correction advance(double dt, double path, bool follow);

  double gap(double correction) const {
    return line_.height() + correction;
  }                      ///< [m], at the last good reading
  double sigma() const;  ///< [m]
  /// What the gap will be at a place of the path with a correction.
  double predicted_gap(double path, double correction) const { return predicted_error(path) + correction; }
  double predicted_sigma(double time, double path) const;  ///< [m], of it then
  bool known() const { return known_; }

  /// Why the print must stop; none: it need not. Sticky.
  GapStop stop() const { return stop_; }
  double blind_since() const { return seen_time_; }  ///< [s], the last good reading
  int missed() const { return missed_; }             ///< frames since then
  /// Of the last kMixedReadings readings, those that were off by more than noise explains, while others
  /// between them were not; 0: its stop has another reason.
  int mixed() const { return mixed_; }
  /// Its stop is that of a reading that has not followed the tool, which rose by this [m]; else 0.
  double unanswered() const { return unanswered_; }
  /// Of the last frames (FrameOutcomes), those without a reading, where for want of them nothing shows that
  /// the readings follow the tool; 0: its stop has another reason.
  int prevented() const { return prevented_; }
  double wanted() const {
    return options_.aim - line_.height();
  }  ///< [m], the correction that would reach the aim

 private:
  double predicted_error(double path) const;
  double line_end() const { return used_path_ + options_.extrapolated_max; }  // [m] of path
  bool lasting_step(double innovation, double variance);
  void judge_mixture(bool jump);
  bool contradicted() const { return (jumps_ & 1) != 0; }  ///< by the last reading
  void begin(const GapObservation& o);
  void use(const GapObservation& o);
  void judge(const GapObservation& o);
  void judge_proof(const GapObservation& o);
  double lowest() const;
  bool excitation_due(double path) const;
  void excite(double dt, double path, bool follow);
  void judge_excitation(const GapObservation& o);
  void judge_silence(const GapObservation& o);
  void prove(const GapObservation& o);
  void raise_unproved();
  void pass_over(double time, double path, GapStop why);
  void raise(GapStop reason) { stop_ = stop_ == GapStop::none ? reason : stop_; }

  GapFollowerOptions options_;
  double calibration_sigma_ = 0;  // [m]
  bool known_ = false;
  GapLine line_;
  int begun_ = 0;  // readings before it is known that agree, and their sum
  double begun_sum_ = 0;
  double begun_path_ = 0;  // of the first of them
  double used_path_ = 0;   // of the last reading that was used
  double stood_ = 0;       // [m], the line's height when it last took up two readings in a row
  double last_reading_ = -1;
  int same_readings_ = 0;                 // in a row, to the last bit
  LastingStep step_, step_from_rest_;     // of the line as it goes on, and as it stood
  double seen_time_ = 0, seen_path_ = 0;  // of the last good reading, or where readings began
  int missed_ = 0;
  std::uint32_t jumps_ = 0;  // a bit for each of the last readings, the newest lowest
  int mixed_ = 0;
  CusumTest response_;
  double held_time_ = 0, held_path_ = 0;  // since when readings ask for more than is proved
  bool held_ = false;
  std::array<int, 16> reasons_{};  // of those, by GapStop
  GapStop stop_ = GapStop::none;
  Correction correction_;  // without excitation
  GapExcitation excitation_;
  bool proved_ = false;    // in this bead
  double asked_time_ = 0;  // [s], readings since then have not answered
  bool asked_ = false;
  double proved_path_ = 0;  // [m], where, and the line's covariance there
  GapLineCovariance proved_line_;
  FrameOutcomes frames_;
  int prevented_ = 0;
  double unanswered_ = 0;
  double advanced_path_ = 0;
};

}  // namespace understudy::control
