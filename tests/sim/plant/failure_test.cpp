// A plant that cannot follow says so; it never gives a result instead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "sim/plant/mujoco/mjcf.h"
#include "sim/plant/mujoco/mujoco_engine.h"
#include "sim/plant/plant.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class MujocoFailure : public testing::Test {
 protected:
  machine::MachineDescription machine_ = machine_g4();
  AsBuilt built_ = make_as_built(machine_, "nominal", 1);
  std::unique_ptr<Plant> plant_ = make_mujoco_plant(machine_, built_, {});
  DriveCommand home_ = drive_command(built_.hexapod, machine_.X_BT_home);
};

TEST_F(MujocoFailure, JumpOfACommandIsAnEngineFailureWithItsTime) {
  for (int k = 0; k < 10; ++k) plant_->step(home_);
  home_.position[3] += from_mm(100);
  EXPECT_THAT(
      [&] { plant_->step(home_); },
      ThrowsMessage<MachineError>(AllOf(HasSubstr("engine failure at 0.0055 s"), HasSubstr("drive 4"))));
}

TEST_F(MujocoFailure, CommandThatIsNotFiniteIsRefused) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    plant_->reset(home_.position);
    DriveCommand command = home_;
    command.velocity[1] = bad;
    EXPECT_THAT([&] { plant_->step(command); }, ThrowsMessage<MachineError>(HasSubstr("drive 2")));
    plant_->reset(home_.position);
    command = home_;
    command.position[5] = bad;
    EXPECT_THAT([&] { plant_->step(command); }, ThrowsMessage<MachineError>(HasSubstr("drive 6")));
  }
}

TEST_F(MujocoFailure, AFailedPlantStaysFailedUntilReset) {
  DriveCommand bad = home_;
  bad.position[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(plant_->step(bad), MachineError);
  EXPECT_THROW(plant_->step(home_), MachineError);
  plant_->reset(home_.position);
  EXPECT_NO_THROW(plant_->step(home_));
}

TEST_F(MujocoFailure, LoopsThatCannotCloseAreAnErrorWithTheLengths) {
  kinematics::AxisVector impossible = home_.position;
  impossible[0] += from_mm(400);
  EXPECT_THAT(
      [&] { plant_->reset(impossible); },
      ThrowsMessage<MachineError>(AllOf(HasSubstr("cannot be closed"), HasSubstr("588.697 188.697"))));
  impossible[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(plant_->reset(impossible), MachineError);
}

TEST_F(MujocoFailure, TimestepMustBePositive) {
  for (const double bad : {0.0, -1e-3, std::numeric_limits<double>::quiet_NaN()}) {
    MujocoOptions options;
    options.timestep = bad;
    EXPECT_THROW(make_mujoco_plant(machine_, built_, options), InputError);
  }
}

TEST_F(MujocoFailure, HardStopFromFullSpeedIsNotAFailure) {
  // An emergency stop: the command stands still from one step to the next at 0.1 m/s of the tip.
  Twist twist = Twist::Zero();
  twist(2) = -0.1;
  Pose X_BT = machine_.X_BT_home;
  for (int k = 0; k < 200; ++k) {
    X_BT.translation().z() = machine_.X_BT_home.translation().z() - 0.1 * k * plant_->timestep();
    ASSERT_NO_THROW(plant_->step(drive_command(built_.hexapod, X_BT, twist)));
  }
  for (int k = 0; k < 200; ++k) ASSERT_NO_THROW(plant_->step(drive_command(built_.hexapod, X_BT)));
}

/// A model of the engine with one falling body.
ModelPointer falling_body(const std::string& size) {
  return load_model("<mujoco><size " + size +
                    "/><worldbody><body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>"
                    "</body></worldbody></mujoco>");
}

TEST(MujocoEngine, SilentResetsOfTheEngineBecomeErrors) {
  const auto model = falling_body("");
  for (mjtNum* mjData::*part : {&mjData::qpos, &mjData::qvel, &mjData::qfrc_applied}) {
    const auto data = make_data(*model);
    checked_step(*model, *data);
    (data.get()->*part)[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT([&] { checked_step(*model, *data); },
                ThrowsMessage<MachineError>(HasSubstr("engine failure at 0.002")));
  }
}

TEST(MujocoEngine, ErrorsBecomeExceptionsAndLeaveNoFile) {
  const TemporaryFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_THAT([] { load_model("<mujoco><nonsense/></mujoco>"); },
              ThrowsMessage<MachineError>(HasSubstr("nonsense")));
  EXPECT_THROW(load_model("no markup at all"), MachineError);
  EXPECT_THROW(
      {
        const auto model = falling_body("nstack='1'");
        const auto data = make_data(*model);
        checked_step(*model, *data);  // the engine's stack overflows: mju_error
      },
      MachineError);
  EXPECT_THROW(
      {
        const auto model = falling_body("");
        const auto data = make_data(*model);
        data->qpos[0] = std::numeric_limits<double>::quiet_NaN();
        checked_step(*model, *data);  // mju_warning
      },
      MachineError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace understudy::sim
