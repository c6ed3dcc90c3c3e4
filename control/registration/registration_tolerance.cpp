#include "control/registration/registration_tolerance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::control {
namespace {

constexpr double kPosition = 0.5e-3;     // [m]
constexpr double kRotation = 5e-3;       // [rad]
constexpr double kRepeatability = 4e-6;  // [m]: microsteps, a screw's error over a turn
// Spread of places over which the whole of an error differs between them (docs/registration.md#the-fit).
constexpr double kWaveShown = 20e-3;  // [m], a wave's length
constexpr double kPlayShown = 80e-3;  // [m], of its square
constexpr double kTipShown = 100e-3;  // [m], half of a workspace
constexpr double kPlayShare = 0.25;   // at most: play changes sides between few of the places

/// [m], RMS from their centre.
double spread_of(const std::vector<ProbingPlace>& places) {
  if (places.empty()) return 0;
  Vec3 centre = Vec3::Zero();
  for (const auto& place : places) centre += place.p_W / static_cast<double>(places.size());
  double squares = 0;
  for (const auto& place : places) squares += (place.p_W - centre).squaredNorm();
  return std::sqrt(squares / static_cast<double>(places.size()));
}

}  // namespace

PartTolerance part_tolerance(const machine::BuiltTolerances& stated) {
  return {stated.part_position > 0 ? stated.part_position : kPosition,
          stated.part_rotation > 0 ? stated.part_rotation : kRotation, stated.part_size};
}

double place_sigma(const machine::BuiltTolerances& stated, const machine::MachineDescription& machine,
                   const std::vector<ProbingPlace>& places) {
  const double spread = spread_of(places);
  const double wave = std::min(1.0, spread / kWaveShown) * stated.part_ripple / std::numbers::sqrt2;
  const double play = std::min(kPlayShare, std::pow(spread / kPlayShown, 2)) * machine.tip_play();
  const double tip =
      machine.calibration && std::isfinite(machine.calibration->tip_sigma)
          ? std::min(1.0, spread / kTipShown) * machine.calibration->tip_sigma / std::numbers::sqrt3
          : 0;
  return std::hypot(std::hypot(wave, tip), std::hypot(play, kRepeatability));
}

}  // namespace understudy::control
