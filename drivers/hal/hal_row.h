// What goes to HAL's streamer and comes back from its sampler, a line of text each (halstreamer, halsampler).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/hal/hal_settings.h"
#include "machine/port.h"

namespace understudy::drivers {

/// One servo period's command. SI, as everywhere.
struct HalRow {
  machine::AxisVector position{};  ///< [m or rad]
  double filament = 0;             ///< [m]
  std::int32_t number = 0;         ///< counts rows: how the sampler tells them
  bool reset = false;              ///< its rising edge closes the emergency-stop latch
  machine::Outputs outputs;
};

/// What HAL was and did in one servo period.
struct HalSample {
  machine::AxisVector position{};  ///< [m or rad], of the drives
  double filament = 0;             ///< [m]
  std::int32_t number = 0;         ///< of the row that is commanded
  std::int32_t underruns = 0;      ///< periods without a row since HAL was loaded
  bool on = false;                 ///< the emergency-stop latch is closed
  bool drives = false;             ///< the drives are enabled
  bool following = false;          ///< every drive is near its command
  bool starved = false;            ///< the watchdog has seen no rows for its time
  bool limit = false;              ///< a limit switch is struck
  bool stop_released = false;      ///< the chain of emergency stops is closed
  machine::AxisVector load{};      ///< [m or rad], by the encoders behind the play, of a machine with such
};

/// Appends the row as a line; nine decimals of mm and degrees.
void append(const HalRow& row, const HalSettings& settings, std::string& text);
/// False for a line that is no sample, as the word "overrun".
bool parse(std::string_view line, const HalSettings& settings, HalSample& sample);

}  // namespace understudy::drivers
