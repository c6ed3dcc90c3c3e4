// What a HAL configuration must know of a machine: one entry an axis, in the units of HAL files (mm,
// degrees). The exporter writes these numbers, and the port compares what is loaded with them.
#pragma once

#include <string>
#include <vector>

#include "machine/description.h"

namespace understudy::drivers {

/// Of a sample, behind the feedback of the axes: row, underruns, six bits.
constexpr std::size_t kStateColumns = 8;

/// "Unit" is mm, or a degree for an axis that turns.
struct HalAxis {
  std::string name;         ///< "l1", "j1", "x", "filament"
  bool angle = false;       ///< degrees
  bool assumed = false;     ///< the machine file does not say: a default that somebody must check
  double scale = 0;         ///< [steps/unit]
  double home = 0;          ///< [unit], where the axis stands when HAL is loaded
  double lower = 0;         ///< [unit], -1e20: without end
  double upper = 0;         ///< [unit], 1e20: without end
  double velocity = 0;      ///< [unit/s], at most
  double acceleration = 0;  ///< [unit/s^2], with which it brakes when the stream ends or the machine stops
  double jump = 0;          ///< [unit/s^2], passed on while setpoints come: a corner's jump of velocity too
  double following = 0;     ///< [unit], the machine stops where the drive is farther from its command
  double count = 0;         ///< [unit], of the encoder behind the play; 0: there is none
  double units(double si) const;  ///< [m or rad] to [unit]
  double si(double units) const;  ///< [unit] to [m or rad]
};

struct HalOptions {
  int base_period_us = 50;  ///< of the thread that makes steps in software
  double watchdog = 0.05;   ///< [s], without a setpoint until the machine stops
  /// [s], by which a drive may be behind at full speed. Without a real-time kernel the threads that command
  /// and that step drift apart by tens of milliseconds.
  double following = 0.005;
};

struct HalSettings {
  std::string machine;           ///< its name
  std::string fingerprint;       ///< of the axes below; a HAL signal of this name is how a port knows them
  double cycle = 0;              ///< [s], between setpoints: period of the servo thread
  std::vector<HalAxis> axes;     ///< the machine's, then "filament" of a tool that prints
  std::size_t machine_axes = 0;  ///< without the filament
  bool load_encoders = false;    ///< every axis of the machine has one
  double brake_time = 0;         ///< [s], from the stop until the drives are off
  HalOptions options;
  bool prints() const { return axes.size() > machine_axes; }
};

/// Throws InputError for a machine whose home its own kinematics does not reach, for one with more encoders
/// behind the play than HAL can tell of at once, and for options out of their range.
HalSettings hal_settings(const machine::MachineDescription& machine, const HalOptions& options = {});

/// One line for each axis whose full speed the software cannot step: more than one step a base period.
std::vector<std::string> too_fast_for_software(const HalSettings& settings);

}  // namespace understudy::drivers
