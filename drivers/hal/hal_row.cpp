#include "drivers/hal/hal_row.h"

#include <charconv>
#include <iterator>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::drivers {
namespace {

template <typename T>
bool take(std::string_view& line, T& value) {
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc()) return false;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return true;
}

bool take(std::string_view& line, bool& value) {
  int bit = 0;
  if (!take(line, bit) || (bit != 0 && bit != 1)) return false;
  value = bit == 1;
  return true;
}

}  // namespace

void append(const HalRow& row, const HalSettings& settings, std::string& text) {
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < settings.axes.size(); ++i) {
    const double si = i < settings.machine_axes ? row.position[i] : row.filament;
    fmt::format_to(out, "{:.9f} ", settings.axes[i].units(si));
  }
  const double nozzle =
      row.outputs.nozzle_temperature > 0 ? row.outputs.nozzle_temperature - kCelsiusZero : 0;
  fmt::format_to(out, "{} {} {:.3f} {:.4f}\n", row.number, row.reset ? 1 : 0, nozzle, row.outputs.fan);
}

bool parse(std::string_view line, const HalSettings& settings, HalSample& s) {
  for (std::size_t i = 0; i < settings.axes.size(); ++i) {
    double units = 0;
    if (!take(line, units)) return false;
    (i < settings.machine_axes ? s.position[i] : s.filament) = settings.axes[i].si(units);
  }
  if (!(take(line, s.number) && take(line, s.underruns) && take(line, s.on) && take(line, s.drives) &&
        take(line, s.following) && take(line, s.starved) && take(line, s.limit) &&
        take(line, s.stop_released)))
    return false;
  for (std::size_t i = 0; settings.load_encoders && i < settings.machine_axes; ++i) {
    double units = 0;
    if (!take(line, units)) return false;
    s.load[i] = settings.axes[i].si(units);
  }
  return true;
}

}  // namespace understudy::drivers
