// Poses of the as-built machine along a path without integrating its dynamics (docs/quasistatic.md).
#pragma once

#include <memory>
#include <span>

#include "sim/plant/plant.h"

namespace understudy::sim {

/// Tip acceleration [m/s^2] up to which the quasistatic plant keeps within 10 um of the MuJoCo plant for play
/// up to 200 um, as long as no strut's load turns. Where a load turns, plays are under way for some 10 to 100
/// ms and the two differ by as much as MuJoCo differs from itself at another timestep (docs/quasistatic.md).
constexpr double kQuasistaticBound = 1.0;

/// One point of a path, motor side.
struct PathSample {
  kinematics::AxisVector position{};      ///< [m or rad], drive displacement
  kinematics::AxisVector velocity{};      ///< [m/s or rad/s]
  kinematics::AxisVector acceleration{};  ///< [m/s^2 or rad/s^2]
};

class QuasistaticMachine;

/// For studies: every sample is at rest in its plays, however far it is from the one before. A play goes
/// where its load pushes it, or stays where it was while that load is below friction; crossing takes no time.
/// Timestep is not used. Neither throws nor allocates once it is made.
class QuasistaticSampler {
 public:
  /// Throws InputError or MachineError as make_quasistatic_plant does.
  QuasistaticSampler(const machine::MachineDescription& machine, const AsBuilt& as_built,
                     const QuasistaticOptions& options = {});
  ~QuasistaticSampler();
  QuasistaticSampler(QuasistaticSampler&&) noexcept;
  QuasistaticSampler& operator=(QuasistaticSampler&&) noexcept;

  /// Back to home, plays where gravity leaves them.
  void restart();
  /// Not ok: X_WT is not touched, and the next sample starts from home.
  kinematics::SolveStatus sample(const PathSample& at, Pose& X_WT);
  /// As many of `path` as are ok, in order.
  std::size_t sample(std::span<const PathSample> path, std::span<Pose> X_WT);
  /// [N] or [N m], as Plant::drive_force, of the last sample.
  kinematics::AxisVector drive_force() const;
  /// [m] or [rad]: where each axis is within its play, positive ahead of its drive.
  kinematics::AxisVector gap() const;
  /// Puts an axis somewhere within its play, clamped: where a study says that it came from. It stays there
  /// while its load is below friction.
  void place_gap(int axis, double gap);

 private:
  std::unique_ptr<QuasistaticMachine> machine_;
};

}  // namespace understudy::sim
