#include "rehearsal/live_twin.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"

namespace understudy::rehearsal {
namespace {

RehearsalRequest on_the_bottle() {
  RehearsalRequest request;
  request.engine = "quasistatic";
  request.fixture = "bottle";
  request.as_built = "nominal";
  return request;
}

TEST(LiveTwin, WaitsForSetpointsAndGoesWhereTheyLead) {
  LiveTwin twin(on_the_bottle());
  const machine::MachineDescription& machine = twin.setup().machine;
  const auto mechanism = machine.make_mechanism();
  const Pose before = twin.true_pose();
  EXPECT_EQ(twin.port().wait_until(0.1), machine::Status::ok);
  EXPECT_LT((twin.true_pose().translation() - before.translation()).norm(), 1e-6);
  std::vector<machine::Setpoint> setpoints;
  for (int n = 1; n <= 200; ++n) {
    machine::Setpoint setpoint;
    setpoint.time = twin.port().now() + n * 2e-3;
    Pose X_BT = machine.X_BT_home;
    X_BT.translation() += machine.X_WB.linear().transpose() * Vec3(0, 0, n * 10e-6);
    ASSERT_EQ(mechanism->inverse(X_BT, {}, std::span(setpoint.position).first(6)),
              kinematics::SolveStatus::ok);
    setpoints.push_back(setpoint);
  }
  ASSERT_EQ(twin.port().submit(setpoints, 1e9), machine::Status::ok);
  ASSERT_EQ(twin.port().wait_until(setpoints.back().time + 0.2), machine::Status::ok);
  // A nominal twin is off by its play and its steps alone.
  EXPECT_NEAR(twin.true_pose().translation().z() - before.translation().z(), 2e-3, 0.1e-3);
  EXPECT_GT(twin.trace().size(), 100u);
  EXPECT_EQ(twin.trace().size(), twin.trace().size());  // asking takes nothing away
}

TEST(LiveTwin, SeesWhatItsCameraSees) {
  LiveTwin twin(on_the_bottle());
  machine::Frame frame;
  const Camera& camera = twin.setup().machine.microscope.camera;
  ASSERT_EQ(twin.port().capture(camera.sensor(), frame, 1e9), machine::Status::ok);
  EXPECT_EQ(frame.image.width(), camera.width);
  EXPECT_GT(frame.received_at, frame.exposed_at);
}

TEST(LiveTwin, RefusesWhatARehearsalRefuses) {
  RehearsalRequest request = on_the_bottle();
  request.engine = "quasistatik";
  EXPECT_THROW(LiveTwin{request}, InputError);
}

}  // namespace
}  // namespace understudy::rehearsal
