// A line to one client at a time: a TCP connection, or a pseudo-terminal that senders open as a serial port.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "rehearsal/serving/serve_address.h"

namespace understudy::rehearsal {

class ServeLine {
 public:
  virtual ~ServeLine() = default;
  /// Where senders find it: "tcp:127.0.0.1:2323", "/tmp/twin (/dev/pts/4)".
  virtual std::string name() const = 0;
  /// Whether a client is there; looks for one, and for one that has left. Further clients are told that the
  /// line is busy.
  virtual bool connected() = 0;
  /// Up to `room` bytes that have come; waits `milliseconds` for the first.
  virtual std::string read(std::size_t room, int milliseconds) = 0;
  /// All of it, or as much as a client takes that is leaving. A client that reads nothing for two seconds is
  /// taken for gone.
  virtual void write(std::string_view bytes) = 0;
};

/// Listens. Throws InputError for an address that cannot be used: in use, no such host, a path that exists.
std::unique_ptr<ServeLine> open_serve_line(const ServeAddress& address);

}  // namespace understudy::rehearsal
