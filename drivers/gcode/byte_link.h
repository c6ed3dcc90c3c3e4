// Bytes to and from a controller, and the clock that they are timed by.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "drivers/port_uri.h"

namespace understudy::drivers {

/// Nothing here waits but wait(). A link that is gone (a cable pulled, a peer that hung up) throws
/// MachineError from send(), receive() or wait().
class ByteLink {
 public:
  virtual ~ByteLink() = default;

  virtual double now() const = 0;  ///< [s], of a clock that only runs forwards
  /// How many of the bytes were taken; 0 where there is no room.
  virtual std::size_t send(std::string_view bytes) = 0;
  /// How many bytes came; 0 where there are none.
  virtual std::size_t receive(std::span<char> bytes) = 0;
  /// Returns at that time, or earlier when bytes have come.
  virtual void wait(double until) = 0;
};

/// serial:///dev/...?baud=N. Throws InputError for a device that is none, MachineError for one that is not to
/// be had (held by another program, no permission).
std::unique_ptr<ByteLink> open_serial_link(const PortUri& uri);

/// tcp://host:port. Throws InputError for an address that is none, MachineError where nobody answers.
std::unique_ptr<ByteLink> open_tcp_link(const PortUri& uri);

}  // namespace understudy::drivers
