#include "kinematics/chain/calibrated_chain.h"

#include <algorithm>
#include <array>

#include "kinematics/chain/chain_mechanism.h"

namespace understudy::kinematics {
namespace {

using Axes = AxisVector;

constexpr double kPathStep = 0.1;  // [rad]; branches are farther apart, but near singular postures

ChainDescription as_drawn(const ChainDescription& description) {
  ChainDescription drawn = description;
  drawn.chain = description.design;
  drawn.design = {};
  return drawn;
}

class CalibratedChain final : public ChainMechanism {
 public:
  CalibratedChain(const ChainDescription& description, std::unique_ptr<Mechanism> drawn)
      : ChainMechanism(description, drawn->follows_spin()), drawn_(std::move(drawn)) {}

  SolveStatus inverse(const Pose& X_ST, std::span<const double> previous,
                      std::span<double> axes) const override {
    const std::size_t n = chain().axes.size();
    if (axes.size() < n || !is_pose(X_ST) || !usable(previous)) return SolveStatus::bad_input;
    // A step along a path: the last axes are nearer than the drawn chain's answer.
    Axes at{};
    if (!previous.empty()) {
      std::copy_n(previous.begin(), n, at.begin());
      const double step = kPathStep * description().length_scale;
      if (solve_from(at, X_ST) == SolveStatus::ok && distance2(previous, at) < step * step) {
        std::copy_n(at.begin(), n, axes.begin());
        return SolveStatus::ok;
      }
    }
    const SolveStatus status = drawn_->inverse(X_ST, previous, std::span(at).first(n));
    // At the end of its reach the drawn chain has no answer where the measured one may.
    if (status != SolveStatus::ok) std::copy_n(near(previous).begin(), n, at.begin());
    const SolveStatus solved = solve_from(at, X_ST);
    if (solved != SolveStatus::ok) return status == SolveStatus::ok ? solved : status;
    settle(previous, std::span(at).first(n));
    std::copy_n(at.begin(), n, axes.begin());
    return SolveStatus::ok;
  }

 private:
  SolveStatus solve_from(Axes& at, const Pose& X_ST) const {
    return solve_numerically(chain(), X_ST, follows_spin(), description().length_scale,
                             std::span(at).first(chain().axes.size()));
  }

  std::unique_ptr<Mechanism> drawn_;
};

}  // namespace

std::unique_ptr<Mechanism> make_calibrated_chain(const ChainDescription& description) {
  return std::make_unique<CalibratedChain>(description, make_chain_mechanism(as_drawn(description)));
}

}  // namespace understudy::kinematics
