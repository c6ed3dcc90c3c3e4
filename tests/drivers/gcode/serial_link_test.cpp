// The whole driver on a pseudo-terminal and on a socket, in real time.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/descriptor.h"
#include "drivers/open_port.h"
#include "tests/drivers/gcode/gcode_trial.h"

namespace understudy::drivers {
namespace {

using machine::Setpoint;
using machine::Status;

/// A scripted controller behind a pseudo-terminal, on the clock of the wall.
class OnTerminal {
 public:
  explicit OnTerminal(Firmware firmware)
      : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    if (::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0) std::abort();
    device_ = ::ptsname(master_.get());
    ScriptedController::Setup peer;
    peer.firmware = firmware;
    peer.letters = firmware == Firmware::grblhal ? "XYZABC" : "XYZUVW";
    peer.extruder = firmware == Firmware::grblhal ? 'U' : 'E';
    peer.start.fill(200);
    controller_ = std::make_unique<ScriptedController>(peer, Mischief{});
    plays_ = std::thread([this] { play(); });
  }
  ~OnTerminal() { pull(); }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  std::string uri(Firmware firmware) const {
    return "serial://" + device_ + "?boot_s=5&reply_s=2&family=" + family_word(firmware);
  }
  /// The controller and its cable are gone.
  void pull() {
    ends_ = true;
    if (plays_.joinable()) plays_.join();
    master_.close();
  }
  const ScriptedController& controller() const { return *controller_; }

 private:
  void play() {
    const auto begin = std::chrono::steady_clock::now();
    char bytes[256];
    while (!ends_) {
      pollfd readable{master_.get(), POLLIN, 0};
      ::poll(&readable, 1, 1);
      const ssize_t n = ::read(master_.get(), bytes, sizeof(bytes));
      if (n > 0) controller_->take({bytes, static_cast<std::size_t>(n)});
      controller_->run_to(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      const std::string said = controller_->give();
      std::size_t written = 0;
      while (written < said.size() && !ends_) {
        const ssize_t w = ::write(master_.get(), said.data() + written, said.size() - written);
        if (w > 0) written += static_cast<std::size_t>(w);
      }
    }
  }

  Descriptor master_;
  std::string device_;
  std::unique_ptr<ScriptedController> controller_;
  std::atomic<bool> ends_{false};
  std::thread plays_;
};

std::vector<Setpoint> there_and_back(const machine::MachinePort& port) {
  std::vector<Setpoint> path;
  const machine::AxisState begin = port.state();
  for (int n = 1; n <= 600; ++n) {
    Setpoint s;
    const double share = n / 600.0, u = share * share * (3 - 2 * share);
    s.time = begin.time + n * 1e-3;
    s.position = begin.position;
    for (std::size_t i = 0; i < 6; ++i) {
      s.position[i] += 2e-3 * std::sin(3 * u);
      s.velocity[i] = 2e-3 * 3 * std::cos(3 * u) * 6 * share * (1 - share) / 0.6;
    }
    if (n == 600) s.velocity = {};
    path.push_back(s);
  }
  return path;
}

class RealTime : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Families, RealTime,
                         testing::Values(Firmware::grblhal, Firmware::marlin, Firmware::reprapfirmware));

TEST_P(RealTime, PrintsOnAPseudoTerminal) {
  OnTerminal peer(GetParam());
  const auto port = open_port(peer.uri(GetParam()), trial_machine());
  const auto path = there_and_back(*port);
  ASSERT_EQ(port->submit(path, 1e9), Status::ok);
  // On a busy computer everything may be late.
  for (int i = 0; i < 100 && port->state().executed < path.size(); ++i)
    ASSERT_EQ(port->wait_until(port->now() + 0.1), Status::ok)
        << dynamic_cast<DriverPort&>(*port).fault_text();
  EXPECT_EQ(port->state().executed, path.size());
  peer.pull();
  EXPECT_NEAR(peer.controller().ran().back().to[0], 1e3 * path.back().position[0], 1e-4);
}

TEST_P(RealTime, ACableThatIsPulledIsAFaultWithinItsTime) {
  OnTerminal peer(GetParam());
  const auto port = open_port(peer.uri(GetParam()), trial_machine());
  ASSERT_EQ(port->submit(there_and_back(*port), 1e9), Status::ok);
  ASSERT_EQ(port->wait_until(0.3), Status::ok);
  peer.pull();
  EXPECT_EQ(port->wait_until(10), Status::faulted);
  EXPECT_EQ(port->state().fault, machine::Fault::power);
  EXPECT_THAT(dynamic_cast<DriverPort&>(*port).fault_text(), testing::HasSubstr("is gone"));
}

TEST(SerialLink, NamesWhatIsNoDevice) {
  const auto refusal = [](const std::string& uri) {
    try {
      (void)open_port(uri, trial_machine());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  EXPECT_THAT(refusal("serial:///dev/no-such-tty?family=marlin"), testing::HasSubstr("No such file"));
  EXPECT_THAT(refusal("serial:///dev/null?family=marlin"), testing::HasSubstr("no serial device"));
  EXPECT_THAT(refusal("serial://?family=marlin"), testing::HasSubstr("name the device"));
  EXPECT_THAT(refusal("tcp://host?family=marlin"), testing::HasSubstr("write tcp://host:port"));
}

}  // namespace
}  // namespace understudy::drivers
