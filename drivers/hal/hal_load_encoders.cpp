#include "drivers/hal/hal_load_encoders.h"

#include <functional>

#include <fmt/format.h>

namespace understudy::drivers {
namespace {

std::string each(const HalSettings& s, const std::function<std::string(const HalAxis&, std::size_t)>& text) {
  if (!s.load_encoders) return {};
  std::string all;
  for (std::size_t i = 0; i < s.machine_axes; ++i) all += text(s.axes[i], i);
  return all;
}

/// "load.l1,load.l2,..."
std::string names(const HalSettings& s, const std::string& prefix) {
  return each(s, [&](const HalAxis& a, std::size_t i) {
    return fmt::format("{}{}{}", i == 0 ? "" : ",", prefix, a.name);
  });
}

}  // namespace

std::string load_encoder_components(const HalSettings& s) {
  if (!s.load_encoders) return {};
  // HAL loads a module once: these share it with the zeros of the drives.
  return "," + names(s, "load.");
}

std::string load_encoder_functions(const HalSettings& s) {
  return each(s, [](const HalAxis& a, std::size_t) {
    return fmt::format("addf load.{}.update-feedback servo\n", a.name);
  });
}

std::string load_encoder_nets(const HalSettings& s, std::size_t first_column) {
  if (!s.load_encoders) return {};
  return "# Encoders behind the play: read back and recorded, nothing is steered by them.\n" +
         each(s,
              [&](const HalAxis& a, std::size_t i) {
                return fmt::format(
                    "net {0}-load => load.{0}.fb-in\n"
                    "setp load.{0}.offset {1:.9g}\n"
                    "net {0}-load-position load.{0}.fb-out => sampler.0.pin.{2}\n",
                    a.name, -a.home, first_column + i);
              }) +
         "\n";
}

std::string simulated_load_encoders(const HalSettings& s) {
  if (!s.load_encoders) return {};
  const HalAxis& first = s.axes.front();
  return fmt::format(
             "# Encoders behind the play, here without play. A real machine replaces these lines, for "
             "instance by\n"
             "#   loadrt encoder num_chan={}\n"
             "#   addf encoder.update-counters base\n"
             "#   addf encoder.capture-position servo 1\n"
             "#   setp encoder.0.position-scale {:.9g}\n"
             "#   net {}-load <= encoder.0.position\n"
             "loadrt scale names={}\n",
             s.machine_axes, 1 / first.count, first.name, names(s, "encoder-of-")) +
         each(s, [](const HalAxis& a, std::size_t) {
           return fmt::format(
               "addf encoder-of-{0} servo 2\n"
               "setp encoder-of-{0}.gain 1\n"
               "net {0}-drive => encoder-of-{0}.in\n"
               "net {0}-load <= encoder-of-{0}.out\n",
               a.name);
         });
}

std::string load_encoder_signals(const HalSettings& s) {
  if (!s.load_encoders) return {};
  const std::string counts = each(s, [](const HalAxis& a, std::size_t i) {
    return fmt::format("{}`{}` {:.9g}", i == 0 ? "" : ", ", a.name, 1 / a.count);
  });
  return fmt::format(
      "| `AXIS-load` | position by the encoder behind the play, counted as `AXIS-drive`; of one that knows "
      "its "
      "own zero, `setp load.AXIS.offset 0`. Counts a unit: {} |\n",
      counts);
}

}  // namespace understudy::drivers
