#include <fcntl.h>
#include <libserialport.h>
#include <termios.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "drivers/gcode/byte_link.h"
#include "drivers/gcode/descriptor_link.h"

namespace understudy::drivers {
namespace {

using Clock = std::chrono::steady_clock;

std::string last_error() {
  char* message = sp_last_error_message();
  std::string text = message ? message : "unknown error";
  sp_free_error_message(message);
  return text;
}

class SerialLink : public ByteLink {
 public:
  SerialLink(sp_port* port, std::string device, int baud) : device_(std::move(device)), port_(port) {
    if (sp_open(port_, SP_MODE_READ_WRITE) != SP_OK) {
      const std::string why = last_error();
      sp_free_port(port_);
      throw MachineError(
          fmt::format("{} cannot be opened: {}; is it held by another program, or may you not use "
                      "it (group dialout)?",
                      device_, why));
    }
    if (sp_set_baudrate(port_, baud) != SP_OK || sp_set_bits(port_, 8) != SP_OK ||
        sp_set_parity(port_, SP_PARITY_NONE) != SP_OK || sp_set_stopbits(port_, 1) != SP_OK ||
        sp_set_flowcontrol(port_, SP_FLOWCONTROL_NONE) != SP_OK) {
      const std::string why = last_error();
      close();
      throw MachineError(fmt::format("{} does not take {} baud: {}", device_, baud, why));
    }
    sp_new_event_set(&readable_);
    sp_add_port_events(readable_, port_, static_cast<sp_event>(SP_EVENT_RX_READY | SP_EVENT_ERROR));
  }
  ~SerialLink() override { close(); }
  SerialLink(const SerialLink&) = delete;
  SerialLink& operator=(const SerialLink&) = delete;

  double now() const override { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  std::size_t send(std::string_view bytes) override {
    return checked(sp_nonblocking_write(port_, bytes.data(), bytes.size()));
  }
  std::size_t receive(std::span<char> bytes) override {
    return checked(sp_nonblocking_read(port_, bytes.data(), bytes.size()));
  }
  void wait(double until) override {
    const double left = until - now();
    if (left <= 0) return;
    if (const auto whole = static_cast<unsigned>(left * 1e3); whole > 0) {
      if (sp_wait(readable_, whole) != SP_OK) throw gone();
      return;
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(left));
  }

 private:
  std::size_t checked(int result) const {
    if (result < 0) throw gone();
    return static_cast<std::size_t>(result);
  }
  MachineError gone() const {
    return MachineError(fmt::format("{} is gone ({}): was the cable pulled?", device_, last_error()));
  }
  void close() {
    if (readable_) sp_free_event_set(readable_);
    sp_close(port_);
    sp_free_port(port_);
  }

  std::string device_;
  sp_port* port_ = nullptr;
  sp_event_set* readable_ = nullptr;
  Clock::time_point begin_ = Clock::now();
};

/// A pseudo-terminal, behind which a program plays the controller: libserialport knows devices alone.
std::unique_ptr<ByteLink> open_terminal(const PortUri& uri) {
  Descriptor file(::open(uri.place.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!file.is_open())
    throw InputError(fmt::format("{}: {}: {}", uri.text, uri.place, std::generic_category().message(errno)));
  termios settings{};
  if (::tcgetattr(file.get(), &settings) != 0)
    throw InputError(fmt::format("{}: {} is no serial device", uri.text, uri.place));
  ::cfmakeraw(&settings);
  ::tcsetattr(file.get(), TCSANOW, &settings);
  return std::make_unique<DescriptorLink>(std::move(file), DescriptorLink::Kind::terminal, uri.place);
}

}  // namespace

std::unique_ptr<ByteLink> open_serial_link(const PortUri& uri) {
  if (uri.place.empty()) throw InputError(uri.text + ": name the device, such as serial:///dev/ttyACM0");
  const int baud = static_cast<int>(uri.number("baud", 115200, 300, 20e6));
  sp_port* port = nullptr;
  if (sp_get_port_by_name(uri.place.c_str(), &port) == SP_OK)
    return std::make_unique<SerialLink>(port, uri.place, baud);
  return open_terminal(uri);
}

}  // namespace understudy::drivers
