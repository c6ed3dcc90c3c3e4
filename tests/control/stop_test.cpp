#include "control/stop.h"

#include <gtest/gtest.h>

#include "machine/loopback_port.h"

namespace understudy::control {
namespace {

using machine::Fault;
using machine::Status;

TEST(Stop, AnAnswerThatIsOkStopsNothing) {
  machine::LoopbackPort port({});
  EXPECT_FALSE(Stop{});
  EXPECT_FALSE(stop_of(Status::ok, port));
  EXPECT_TRUE(stop_of(Status::ok, port).why.empty());
}

TEST(Stop, TellsAFaultFromAnAnswerThatIsNone) {
  machine::LoopbackPort port({});
  ASSERT_EQ(port.wait_until(2), Status::ok);
  const Stop refused = stop_of(Status::rejected, port);
  EXPECT_TRUE(refused);
  EXPECT_EQ(refused.fault, Fault::none);
  EXPECT_EQ(refused.time, 2);
  EXPECT_EQ(refused.why, "the machine did not take the motion: rejected");
  port.inject_fault(Fault::limit_switch);
  const Stop faulted = stop_of(Status::faulted, port);
  EXPECT_EQ(faulted.status, Status::faulted);
  EXPECT_EQ(faulted.fault, Fault::limit_switch);
  EXPECT_EQ(faulted.why, "the machine reports a fault: limit switch");
}

TEST(Stop, OfTheGapKeepsItsReasonAndTheFaultThatStands) {
  machine::LoopbackPort port({});
  const Stop sound = stop_of(GapStop::no_dot, "12 frames without one", port);
  EXPECT_TRUE(sound);
  EXPECT_EQ(sound.gap, GapStop::no_dot);
  EXPECT_EQ(sound.status, Status::ok);
  EXPECT_EQ(sound.why, "no dot: 12 frames without one");
  port.inject_fault(Fault::drive);
  const Stop both = stop_of(GapStop::port_failed, "no picture", port);
  EXPECT_EQ(both.gap, GapStop::port_failed);
  EXPECT_EQ(both.status, Status::faulted);
  EXPECT_EQ(both.fault, Fault::drive);
}

}  // namespace
}  // namespace understudy::control
