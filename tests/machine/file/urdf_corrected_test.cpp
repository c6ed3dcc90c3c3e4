#include "machine/file/urdf_corrected.h"

#include <gmock/gmock.h>

#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/random.h"
#include "machine/file/urdf_chain.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Two turns, a slide, a fixed flange; what is beside origins shall stay.
constexpr const char* kArm = R"(<?xml version="1.0"?>
<robot name="mine">
  <link name="base_link"><visual><geometry><mesh filename="package://mine/base.dae"/></geometry></visual></link>
  <link name="upper"/><link name="fore"/><link name="slide"/><link name="tool0"/><link name="cable"/>
  <joint name="shoulder" type="revolute"><parent link="base_link"/><child link="upper"/>
    <origin xyz="0 0 0.3" rpy="0 0 0.2"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="150" velocity="2"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.1 0 0.4" rpy="1.5707963 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="90" velocity="2"/></joint>
  <joint name="reach" type="prismatic"><parent link="fore"/><child link="slide"/>
    <origin xyz="0.2 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="0.3" effort="50" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="slide"/><child link="tool0"/><origin xyz="0.05 0 0" rpy="0 0.5 0"/></joint>
  <joint name="clip" type="fixed"><parent link="upper"/><child link="cable"/><origin xyz="0 0.05 0.1"/></joint>
</robot>
)";

class UrdfCorrected : public ::testing::Test {
 protected:
  /// The arm of `text`, built with errors of 1 mm and 5 mrad; its tool sits 100 mm before `tool_link`.
  MachineDescription built(const std::string& text, const std::string& tool_link) {
    write_file(folder_ / "arm.urdf", text);
    MachineDescription machine;
    kinematics::ChainDescription& known = machine.model.emplace<ChainModel>().kinematics;
    known.chain = read_urdf(folder_ / "arm.urdf", "base_link", tool_link).chain;
    known.chain.X_OT_zero.translation() += known.chain.X_OT_zero.linear() * Vec3(0, 0, 0.1);
    known.design = known.chain;
    Random random(3, "corrected urdf");
    const auto some = [&random](double sigma) {
      return Vec3(sigma * random.normal(), sigma * random.normal(), sigma * random.normal());
    };
    for (kinematics::ChainAxis& axis : known.chain.axes) {
      axis.point += some(1e-3);
      axis.direction = (exp_rotation(some(5e-3)) * axis.direction).normalized();
    }
    known.chain.X_OS_zero = make_pose(Mat3(exp_rotation(some(5e-3))), some(1e-3));
    known.chain.X_OT_zero = make_pose(Mat3(exp_rotation(some(5e-3)) * known.chain.X_OT_zero.linear()),
                                      known.chain.X_OT_zero.translation() + some(1e-3));
    return machine;
  }
  kinematics::Chain read_back(const std::string& text, const std::string& tool_link) {
    write_file(folder_ / "corrected.urdf", text);
    kinematics::Chain chain = read_urdf(folder_ / "corrected.urdf", "base_link", tool_link).chain;
    chain.X_OT_zero.translation() += chain.X_OT_zero.linear() * Vec3(0, 0, 0.1);
    return chain;
  }
  static void expect_same_poses(const kinematics::Chain& a, const kinematics::Chain& b) {
    Random random(4, "poses");
    for (int k = 0; k < 20; ++k) {
      const std::vector<double> q{random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(0, 0.3)};
      EXPECT_LT((kinematics::forward(a, q).matrix() - kinematics::forward(b, q).matrix()).norm(), 1e-9);
    }
  }
  TemporaryFolder folder_;
};

TEST_F(UrdfCorrected, GivesThePosesOfTheCalibratedChainAndChangesOriginsOnly) {
  const MachineDescription machine = built(kArm, "tool0");
  const std::string text = corrected_urdf(machine, folder_ / "arm.urdf", "tool0");
  expect_same_poses(machine.chain().kinematics.chain, read_back(text, "tool0"));
  for (const char* kept : {"package://mine/base.dae", "effort=\"150\"", "<link name=\"tool0\"/>",
                           "<origin xyz=\"0 0.05 0.1\"/>", "robot name=\"mine\""})
    EXPECT_THAT(text, HasSubstr(kept));
  for (const char* changed : {"xyz=\"0 0 0.3\"", "xyz=\"0.1 0 0.4\"", "xyz=\"0.05 0 0\""})
    EXPECT_THAT(text, Not(HasSubstr(changed)));
}

TEST_F(UrdfCorrected, AToolLinkThatAnAxisMovesGetsALinkBelowIt) {
  const MachineDescription machine = built(kArm, "slide");
  const std::string text = corrected_urdf(machine, folder_ / "arm.urdf", "slide");
  EXPECT_THAT(text, HasSubstr("<link name=\"slide_calibrated\"/>"));
  expect_same_poses(machine.chain().kinematics.chain, read_back(text, "slide_calibrated"));
}

TEST_F(UrdfCorrected, OfAMachineAsDrawnIsTheFileItself) {
  MachineDescription machine = built(kArm, "tool0");
  machine.chain().kinematics.design = {};
  EXPECT_EQ(corrected_urdf(machine, folder_ / "arm.urdf", "tool0"), kArm);
}

}  // namespace
}  // namespace understudy::machine
