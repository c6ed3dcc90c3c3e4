#include "drivers/open_port.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "drivers/gcode/gcode_port.h"
#include "drivers/hal/hal_port.h"
#include "drivers/loopback.h"
#include "drivers/port_uri.h"

namespace understudy::drivers {

std::unique_ptr<machine::MachinePort> open_port(const std::string& text,
                                                const machine::MachineDescription& machine) {
  const PortUri uri = parse_port_uri(text);
  if (uri.scheme == "loopback") return open_loopback(uri, machine);
  if (uri.scheme == "serial" || uri.scheme == "tcp") return open_gcode(uri, machine);
  if (uri.scheme == "hal") return open_hal_port(text, machine);
  throw InputError(fmt::format("{}: unknown kind of port '{}': one of {}", text, uri.scheme,
                               fmt::join({"loopback", "serial", "tcp", "hal"}, ", ")));
}

}  // namespace understudy::drivers
