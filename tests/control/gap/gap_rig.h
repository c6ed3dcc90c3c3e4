// A machine for the gap controller's tests: a loopback port whose drives obey, a tool that is beside where
// the controller believes it, and a microscope that draws the dot by exact geometry.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include <Eigen/LU>

#include "control/cycle.h"
#include "control/gap/gap_controller.h"
#include "core/random_vector.h"
#include "machine/loopback_port.h"
#include "tests/control/gap/dot_world.h"

namespace understudy::control {

constexpr int kForGood = std::numeric_limits<int>::max();  // frames

struct GapRigOptions {
  DotWorld world;
  Vec3 tip_error_W{0, 0, 0};  ///< [m], true tip minus commanded tip
  Vec3 tool_error{0, 0, 0};   ///< [rad], rotation vector in W
  double jitter_px = 0.35;    ///< 1 sigma of speckle (docs/reference.md#dot-and-gap: 0.30 to 0.46 px)
  std::uint64_t seed = 1;
};

class GapRig {
 public:
  using Options = GapRigOptions;
  /// Changes the picture, or refuses it, before it reaches the controller.
  using FrameFault = std::function<bool(const Pose& X_WT_commanded, Image& image)>;

  GapRig(const machine::MachineDescription& machine, const Options& options)
      : machine_(machine),
        options_(options),
        mechanism_(machine.make_mechanism()),
        random_(options.seed, "gap rig"),
        port_(port_options(), [this](const machine::AxisState& state, const Region& region, Image& image) {
          return draw(state, region, image);
        }) {}
  GapRig(const GapRig&) = delete;

  machine::LoopbackPort& port() { return port_; }
  void set_frame_fault(FrameFault fault) { frame_fault_ = std::move(fault); }
  /// Added to the commanded tip when the truth is asked for; for errors that come and go.
  void set_play(std::function<Vec3(const Pose& X_WT_commanded)> play) { play_ = std::move(play); }

  Pose commanded(const kinematics::AxisVector& axes) const {
    Pose X_BT;
    const auto solved =
        mechanism_->forward(std::span<const double>(axes.data(), 6), machine_.X_BT_home, X_BT);
    if (solved != kinematics::SolveStatus::ok) throw std::runtime_error("the rig's axes belong to no pose");
    return machine_.X_WB * X_BT;
  }
  Pose truth(const Pose& X_WT_commanded) const {
    Pose X = X_WT_commanded;
    X.linear() = exp_rotation(options_.tool_error) * X.linear();
    X.translation() += options_.tip_error_W;
    if (play_) X.translation() += play_(X_WT_commanded);
    return X;
  }
  double gap_at(const Pose& X_WT_commanded) const { return true_gap(options_.world, truth(X_WT_commanded)); }
  double gap_now() const { return gap_at(commanded(port_.state().position)); }
  Pose commanded_now() const { return commanded(port_.state().position); }

  /// As wide as the dot of this picture.
  void draw_spot(const Vec2& at, double peak, Image& image) {
    const double ambient = machine_.microscope.ambient_level;
    const Eigen::Matrix2d inverse = spread_.inverse();
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        const Vec2 d = Vec2(image.region.x + x, image.region.y + y) - at;
        const double r2 = d.dot(inverse * d);
        double level = ambient + static_cast<double>(noise() % 7) - 3;
        if (r2 < 36) level += peak * std::exp(-r2 / 2);
        image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
                     static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
      }
  }

 private:
  machine::LoopbackPort::Options port_options() const {
    machine::LoopbackPort::Options o;
    if (mechanism_->inverse(machine_.X_BT_home, {}, std::span<double>(o.start.data(), 6)) !=
        kinematics::SolveStatus::ok)
      throw std::runtime_error("the rig has no home");
    o.frame_time = machine_.microscope.exposure + machine_.microscope.transfer;
    return o;
  }

  bool draw(const machine::AxisState& state, const Region& region, Image& image) {
    image.region = region;
    image.pixels.resize(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
    const Pose X = commanded(state.position);
    const auto dot = exact_dot(machine_, options_.world, truth(X));
    const auto spread = exact_spread(machine_, options_.world, truth(X));
    if (!dot || !spread) return false;
    spread_ = *spread;
    draw_spot(*dot + options_.jitter_px * normal_vec2(random_), machine_.laser.peak_level, image);
    return !frame_fault_ || frame_fault_(X, image);
  }

  std::uint32_t noise() {  // xorshift: a third of a million draws a frame
    noise_ ^= noise_ << 13;
    noise_ ^= noise_ >> 17;
    return noise_ ^= noise_ << 5;
  }

  const machine::MachineDescription& machine_;
  Options options_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  Random random_;
  std::uint32_t noise_ = 2463534242u;
  Eigen::Matrix2d spread_ = Eigen::Matrix2d::Identity();  // [px^2]
  FrameFault frame_fault_;
  std::function<Vec3(const Pose&)> play_;
  machine::LoopbackPort port_;
};

/// Something that stands before the picture, from an edge through a point on, towards `side`.
inline void hide_beyond(const Vec2& edge, const Vec2& side, Image& image) {
  constexpr std::uint8_t kDark = 12;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if ((Vec2(image.region.x + x, image.region.y + y) - edge).dot(side) > 0)
        image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
                     static_cast<std::size_t>(x)] = kDark;
}

/// Moves through the planner, as in print(), and remembers where it was told to go.
class RigMotion : public GapMotion {
 public:
  RigMotion(const machine::MachineDescription& machine, GapRig& rig)
      : cycle_(machine, rig.port(), machine.X_WB * machine.X_BT_home), port_(rig.port()) {}

  machine::Status move_to(const Pose& X_WT) override {
    targets.push_back(X_WT);
    toolpath::Step step;
    step.kind = toolpath::StepKind::move;
    step.feed = 5e-3;
    step.X_WT = X_WT;
    if (const Stop stop = cycle_.push(step)) return stop.status;
    return cycle_.come_to_rest().status;
  }
  machine::MachinePort& port() override { return port_; }

  std::vector<Pose> targets;

 private:
  ControlCycle cycle_;
  machine::MachinePort& port_;
};

}  // namespace understudy::control
