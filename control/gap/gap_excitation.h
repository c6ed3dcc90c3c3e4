// A deliberate motion of the tool along its axis while it prints: an excitation, as system identification
// calls a test signal. The part's own dot follows it; a spot that stands still in the picture (a thread of
// plastic on the nozzle) does not, whatever the machine's own error does meanwhile. The motion leads away
// from the part and back, inside the accepted band, and takes no time: the tool goes on along its path.
#pragma once

#include <array>
#include <cstddef>

namespace understudy::control {

struct GapExcitationOptions {
  double amplitude = 0;             ///< [m], away from the part; the second look goes twice as far; 0: none
  double rate_max = 0.3e-3;         ///< [m/s]
  double acceleration_max = 12e-3;  ///< [m/s^2]
  double suspected = 5;  ///< [nats] for a spot that stands still, after which the tool rises farther
  double decided = 10;   ///< [nats]: one in 22 000 is wrong
};

/// Half a cosine between two heights. The value is the integral of the rate, cycle by cycle.
class ExcitationMotion {
 public:
  /// To `height` [m] from where it is, in the time that the limits ask for; from a motion by way of a rest.
  void go_to(double height, double rate_max, double acceleration_max);
  /// To rest, wherever that is.
  void brake(double acceleration_max);
  void advance(double dt);
  double value() const { return value_; }  ///< [m]
  double rate() const { return rate_; }    ///< [m/s]
  bool arrived() const { return time_ >= duration_ && !turning_; }
  bool braked() const { return braking_ > 0 && !turning_; }
  double target() const { return target_; }  ///< [m]

 private:
  void start();

  double target_ = 0, peak_ = 0;                // [m], [m/s]
  double rate_max_ = 0, acceleration_max_ = 0;  // of the motion to the target
  double time_ = 0, duration_ = 0;              // [s]
  double braking_ = 0;                          // [m/s^2]
  bool turning_ = false;                        // brakes, and starts to the target from there
  double value_ = 0, rate_ = 0;
};

/// One reading during an excitation.
struct ExcitedReading {
  double path = 0;        ///< [m]
  double correction = 0;  ///< [m], all of it, in the middle of the exposure
  double gap = 0;         ///< [m], as read
  double still = 0;       ///< [m], what a spot that stands still would read, up to a constant
  double variance = 0;    ///< [m^2]
};

/// Two explanations of the last readings: a part below a tool that moved, and a spot that stands still.
/// Either may drift along the path by a line whose slope has a prior.
class ExcitationTest {
 public:
  void clear() { filled_ = 0; }
  /// All but the last `kept`, which show the tool before it moves.
  void begin(std::size_t kept);
  void add(const ExcitedReading& reading);
  struct Result {
    double evidence = 0;  ///< [nats] for the part, negative for the spot; a misfit of both weakens it
    double scatter = 0;   ///< [m^2], mean square of what the better one leaves
  };
  Result result(double slope, double slope_sigma) const;  ///< prior [m/m]

 private:
  double misfit(bool follows, double slope, double slope_sigma) const;

  std::array<ExcitedReading, 32> readings_{};
  std::size_t filled_ = 0;
};

class GapExcitation {
 public:
  enum class Answer { open, follows, stands_still };

  explicit GapExcitation(const GapExcitationOptions& options) : options_(options) {}

  bool available() const { return options_.amplitude > 0; }
  bool running() const { return phase_ != Phase::idle; }
  /// The tool rises farther because what shines has not followed it so far. Any other motion would hide the
  /// answer.
  bool suspects() const { return running() && suspected_; }
  /// The tool rises and comes back; an answer may come before that. The gap's own change over the path has a
  /// slope and its sigma [m/m].
  void begin(double slope, double slope_sigma);
  /// To rest at once, without an answer.
  void abandon();
  /// At the programmed height, or on the way there with nothing more to learn.
  bool lowered() const { return motion_.target() == 0 && !motion_.braked(); }
  void lower() { go_to(0); }

  /// A cycle later.
  void advance(double dt) { motion_.advance(dt); }
  double value() const { return motion_.value(); }  ///< [m], away from the part
  double rate() const { return motion_.rate(); }    ///< [m/s]

  /// Every finite reading, also between excitations. Once it stands still, the tool stays up.
  Answer observe(const ExcitedReading& reading);

 private:
  enum class Phase { idle, first, second, returning };
  void go_to(double height) { motion_.go_to(height, options_.rate_max, options_.acceleration_max); }
  Answer finish(Answer answer);

  GapExcitationOptions options_;
  double slope_ = 0, slope_sigma_ = 0;
  ExcitationMotion motion_;
  ExcitationTest test_;
  ExcitationTest second_look_;  // its readings alone: those before it are what made it necessary
  Phase phase_ = Phase::idle;
  int after_ = 0;           // readings since the motion arrived
  bool undecided_ = false;  // the readings of the excitation before count on
  bool suspected_ = false;  // of a spot that stands still: the tool rises farther
};

}  // namespace understudy::control
