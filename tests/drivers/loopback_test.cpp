#include "drivers/loopback.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "drivers/open_port.h"

namespace understudy::drivers {
namespace {

TEST(Loopback, RestsAtHomeWithinTheRangesOfTheMachine) {
  const auto machine = machine::load_machine("hexapod");
  const auto port = open_port("loopback://", machine);
  EXPECT_EQ(port->axis_count(), 6);
  machine::Setpoint far;
  far.time = 1;
  far.position = port->state().position;
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(far.position[static_cast<std::size_t>(i)], 0.205, 0.035);  // 170 to 240 mm
  far.position[0] = 0.2401;
  EXPECT_EQ(port->submit({&far, 1}, 1), machine::Status::rejected);
}

TEST(Loopback, ItsClockRunsInStepsOfTheTwin) {
  const auto machine = machine::load_machine("five-axis");
  const auto port = open_port("loopback://", machine);
  ASSERT_EQ(port->wait_until(0.0101), machine::Status::ok);
  EXPECT_EQ(port->now(), 20 * 0.5e-3);
}

TEST(Loopback, HasNoPlaceAndOtherSchemesAreRefused) {
  const auto machine = machine::load_machine("arm");
  EXPECT_THROW(open_port("loopback://here", machine), InputError);
  EXPECT_THROW(open_port("loopback://?baud=1", machine), InputError);
  EXPECT_THROW(open_port("carrier-pigeon://", machine), InputError);
}

}  // namespace
}  // namespace understudy::drivers
