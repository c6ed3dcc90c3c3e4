#include "drivers/emergency_port.h"

#include <gtest/gtest.h>

#include "machine/loopback_port.h"

namespace understudy::drivers {
namespace {

using machine::Fault;
using machine::LoopbackPort;
using machine::Setpoint;
using machine::Status;

/// A machine that counts how often its button was pressed.
class Machine : public DriverPort {
 public:
  int axis_count() const override { return port_.axis_count(); }
  double now() const override { return port_.now(); }
  machine::AxisState state() const override { return port_.state(); }
  Status submit(std::span<const Setpoint> s, double deadline) override { return port_.submit(s, deadline); }
  Status wait_until(double time) override { return port_.wait_until(time); }
  Status urgent(machine::UrgentCommand command) override { return port_.urgent(command); }
  Status set_outputs(const machine::Outputs& o, double deadline) override {
    return port_.set_outputs(o, deadline);
  }
  Status capture(const Region& r, machine::Frame& f, double deadline) override {
    return port_.capture(r, f, deadline);
  }
  std::string fault_text() const override { return ""; }
  void emergency_stop() override {
    ++pressed;
    at = now();
  }
  int pressed = 0;
  double at = 0;
  const machine::Outputs& outputs() const { return port_.outputs(); }

 private:
  LoopbackPort port_{{}};
};

TEST(EmergencyPort, StopsTheMachineAtOnceAndOnlyOnce) {
  Machine machine;
  bool button = false;
  EmergencyPort port(machine, [&] { return button; });
  ASSERT_EQ(port.set_outputs({483, 1}, 1), Status::ok);
  ASSERT_EQ(port.wait_until(1), Status::ok);
  button = true;
  EXPECT_EQ(port.wait_until(5), Status::faulted);
  EXPECT_EQ(machine.pressed, 1);
  EXPECT_EQ(machine.at, 1);
  EXPECT_TRUE(machine.outputs().off());
  EXPECT_EQ(port.state().fault, Fault::emergency_stop);
  EXPECT_EQ(port.wait_until(6), Status::faulted);
  EXPECT_EQ(machine.pressed, 1);
  EXPECT_EQ(port.submit({}, 9), Status::faulted);
  EXPECT_EQ(port.set_outputs({483, 0}, 9), Status::faulted);
}

TEST(EmergencyPort, LooksAtTheButtonWhileTimePasses) {
  Machine machine;
  EmergencyPort port(machine, [&] { return machine.now() > 0.5; });
  EXPECT_EQ(port.wait_until(5), Status::faulted);
  EXPECT_LT(machine.at, 0.53) << "20 ms later at most";
}

}  // namespace
}  // namespace understudy::drivers
