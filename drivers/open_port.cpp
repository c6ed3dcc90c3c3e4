#include "drivers/open_port.h"

#include <functional>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "drivers/loopback.h"
#include "drivers/port_uri.h"

namespace understudy::drivers {

std::unique_ptr<machine::MachinePort> open_port(const std::string& text,
                                                const machine::MachineDescription& machine) {
  const PortUri uri = parse_port_uri(text);
  if (uri.scheme == "loopback") return open_loopback(uri, machine);
  throw InputError(fmt::format("{}: unknown kind of port '{}': loopback", text, uri.scheme));
}

}  // namespace understudy::drivers
