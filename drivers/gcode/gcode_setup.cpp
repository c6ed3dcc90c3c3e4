// The options of serial:// and tcp://.
#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "drivers/gcode/gcode_port.h"

namespace understudy::drivers {
namespace {

bool yes_or_no(const PortUri& uri, const char* key, bool otherwise) {
  const std::string word = uri.option(key, otherwise ? "yes" : "no");
  if (word != "yes" && word != "no")
    throw InputError(fmt::format("{}: {}={}: yes or no", uri.text, key, word));
  return word == "yes";
}

}  // namespace

GcodeSetup gcode_setup(const PortUri& uri, const machine::MachineDescription& machine) {
  uri.check_options({"family", "baud", "axes", "extruder", "home", "outputs", "latency_ms", "reply_s",
                     "boot_s", "rx_bytes", "window", "tolerance_um", "tolerance_deg", "tolerance_ms"});
  GcodeSetup setup;
  if (uri.option("family").empty())
    throw InputError(uri.text +
                     ": name the controller by family=grblhal, marlin, reprapfirmware or linuxcnc");
  setup.family = gcode_family(uri.option("family"));
  const bool linuxcnc = setup.family == GcodeFamily::linuxcnc;
  if (linuxcnc && uri.scheme != "tcp")
    throw InputError(uri.text +
                     ": linuxcncrsh is reached by tcp://host:port, port 5007 where nothing else is set");
  setup.axes = gcode_axes(setup.family, machine, uri);
  setup.session.home = yes_or_no(uri, "home", false);
  setup.outputs = yes_or_no(uri, "outputs", setup.family != GcodeFamily::grblhal);
  setup.latency = 1e-3 * uri.number("latency_ms", linuxcnc ? 500 : 250, 50, 2000);
  setup.session.reply_time = uri.number("reply_s", 5, 0.5, 600);
  setup.session.boot_time = uri.number("boot_s", 10, 0.5, 120);
  setup.session.receive_buffer = static_cast<std::size_t>(uri.number("rx_bytes", 128, 128, 65536));
  setup.session.window = static_cast<int>(uri.number("window", 1, 1, 16));
  setup.tolerance.length = 1e-6 * uri.number("tolerance_um", 2, 0.5, 1000);
  setup.tolerance.angle = from_deg(uri.number("tolerance_deg", to_deg(2e-5), 1e-4, 1));
  setup.tolerance.time = 1e-3 * uri.number("tolerance_ms", linuxcnc ? 10 : 1, 0, 100);
  for (int i = 0; i < setup.axes.count(); ++i) {
    const auto axis = static_cast<std::size_t>(i);
    setup.session.step[axis] = machine.drives[axis].step();
  }
  return setup;
}

std::unique_ptr<GcodePort> open_gcode(const PortUri& uri, const machine::MachineDescription& machine) {
  GcodeSetup setup = gcode_setup(uri, machine);
  if (setup.family == GcodeFamily::linuxcnc) setup.another = [uri] { return open_tcp_link(uri); };
  auto link = uri.scheme == "tcp" ? open_tcp_link(uri) : open_serial_link(uri);
  return std::make_unique<GcodePort>(std::move(link), setup, machine);
}

}  // namespace understudy::drivers
