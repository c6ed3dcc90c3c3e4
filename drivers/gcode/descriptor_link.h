// Bytes over an open file of the operating system: a socket, or a terminal that is no serial device.
#pragma once

#include <chrono>
#include <string>

#include "core/file/descriptor.h"
#include "drivers/gcode/byte_link.h"

namespace understudy::drivers {

class DescriptorLink : public ByteLink {
 public:
  enum class Kind { socket, terminal };
  /// The file must not block. `peer`: its name in errors.
  DescriptorLink(Descriptor file, Kind kind, std::string peer)
      : file_(std::move(file)), kind_(kind), peer_(std::move(peer)) {}

  double now() const override;
  std::size_t send(std::string_view bytes) override;
  std::size_t receive(std::span<char> bytes) override;
  void wait(double until) override;

 private:
  Descriptor file_;
  Kind kind_;
  std::string peer_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace understudy::drivers
