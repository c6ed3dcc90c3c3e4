#include "control/gap/sensor_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "control/gap/confidence.h"
#include "control/gap/gap_reading.h"
#include "core/units.h"
#include "machine/optics_mounting.h"

namespace understudy::control {
namespace {

constexpr double kNoise = 5e-6;  // [m], of an approach's last estimate, at most (docs/gap-control.md#figures)

}  // namespace

/// The controller takes a dot that is displaced for one of another gap.
bool reading_derivatives(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                         machine::MountingVector& derivatives) {
  constexpr double kGapStep = 1e-6;    // [m]
  constexpr double kErrorStep = 1e-6;  // [m], [rad] and a share: the track is smooth over millimetres
  const machine::OpticsMounting mounting = machine::mounting_of(machine);
  Vec2 ahead, behind;
  if (!dot_pixel(machine.laser, machine.microscope, surface, gap + kGapStep, ahead) ||
      !dot_pixel(machine.laser, machine.microscope, surface, gap - kGapStep, behind))
    return false;
  const Vec2 rate = (ahead - behind) / (2 * kGapStep);  // [px/m]
  for (int i = 0; i < machine::kMountingFreedoms; ++i) {
    machine::MountingVector error = machine::MountingVector::Zero();
    machine::Laser laser = machine.laser;
    machine::Microscope microscope = machine.microscope;
    error[i] = kErrorStep;
    machine::set_mounting(machine::moved(mounting, error), laser, microscope);
    if (!dot_pixel(laser, microscope, surface, gap, ahead)) return false;
    machine::set_mounting(machine::moved(mounting, -error), laser, microscope);
    if (!dot_pixel(laser, microscope, surface, gap, behind)) return false;
    derivatives[i] = rate.dot((ahead - behind) / (2 * kErrorStep)) / rate.squaredNorm();
  }
  return true;
}

double calibration_sigma(const machine::MachineDescription& machine, const LocalSurface& surface,
                         double gap) {
  if (!machine.gap_sensor) return 0;
  machine::MountingVector derivatives;
  if (!reading_derivatives(machine, surface, gap, derivatives))
    return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(0.0, derivatives.dot(machine.gap_sensor->covariance * derivatives)));
}

std::string too_uncertain(const machine::GapLimits& limits, double sigma) {
  return fmt::format(
      "the calibration of the gap sensor leaves {:.3f} mm of the gap here (1 sigma): 3 sigma do not fit into "
      "the accepted {:.3f} to {:.3f} mm",
      to_mm(sigma), to_mm(limits.accepted_min), to_mm(limits.accepted_max));
}

SafeAim safe_aim(const machine::MachineDescription& machine, const LocalSurface& surface, double aim) {
  if (!machine.gap_sensor) return {aim, 0, true};
  const machine::GapLimits& limits = machine.gap;
  const double sigma = calibration_sigma(machine, surface, aim);
  const double margin = kSafeSigmas * std::hypot(sigma, kNoise);
  const double middle = 0.5 * (limits.accepted_min + limits.accepted_max);
  if (!(margin <= middle - limits.accepted_min)) return {middle, sigma, false};
  return {std::clamp(aim, limits.accepted_min + margin, limits.accepted_max - margin), sigma, true};
}

}  // namespace understudy::control
