// The follower in its loop of delays, with a gap that is known in closed form: setpoints are decided `kLead`
// before they take force, a frame shows the middle of its exposure and comes after transfer.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "control/gap/gap_follower.h"
#include "core/random.h"

namespace understudy::control {

constexpr double kCycle = 1e-3;         // [s]
constexpr double kQueueLead = 0.04;     // [s], frame and a margin of 15 ms
constexpr double kHalfExposure = 5e-3;  // [s], hexapod: 10 ms
constexpr double kFrame = 25e-3;        // [s], exposure and transfer

class FollowerLoop {
 public:
  /// Gap without correction, by time [s] and path [m].
  using Error = std::function<double(double time, double path)>;
  /// What a frame reads for a gap, or why there is none.
  struct Look {
    GapStop seen = GapStop::none;
    double gap = 0;
  };
  using Camera = std::function<Look(double time, double path, double gap)>;
  struct Point {
    double time = 0, correction = 0, rate = 0, gap = 0, excitation = 0;
  };

  FollowerLoop(const GapFollowerOptions& options, Error error, double noise = 0, std::uint64_t seed = 1)
      : follower(options), error_(std::move(error)), noise_(noise), random_(seed, "follower loop") {}

  void set_camera(Camera camera) { camera_ = std::move(camera); }
  double speed = 5e-3;  ///< [m/s] of path

  /// Until `seconds`, or the follower asks to stop.
  void run(double seconds) {
    double now = 0, frame_due = kFrame, exposed = kHalfExposure;
    for (; now < seconds && follower.stop() == GapStop::none; now += kCycle) {
      const double time = now + kQueueLead, path = speed * time;
      const auto c = follower.advance(kCycle, path, true);
      points.push_back({time, c.value, c.rate, error_(time, path) + c.value, c.excitation});
      if (now < frame_due) continue;
      take(exposed);
      exposed = now + kHalfExposure;
      frame_due = now + kFrame;
    }
  }

  GapFollower follower;
  std::vector<Point> points;
  std::vector<GapVerdict> verdicts;

 private:
  void take(double exposed) {
    const double path = speed * exposed;
    const Point at = at_time(exposed);
    const double gap = error_(exposed, path) + at.correction;
    Look look{GapStop::none, gap};
    if (camera_) look = camera_(exposed, path, gap);
    const double sigma = std::max(noise_, 0.1e-6);
    if (look.seen != GapStop::none)
      follower.miss(exposed, path, look.seen);
    else
      verdicts.push_back(follower.observe(
          {exposed, path, at.correction, look.gap + noise_ * random_.normal(), sigma, 0, at.excitation}));
  }
  Point at_time(double time) const {
    const auto index = static_cast<std::ptrdiff_t>((time - kQueueLead) / kCycle);
    return index < 0 || points.empty() ? Point{} : points[static_cast<std::size_t>(index)];
  }

  Error error_;
  double noise_;
  Random random_;
  Camera camera_;
};

}  // namespace understudy::control
