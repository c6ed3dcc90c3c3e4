// Open chains in machine files: what the shipped ones say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "kinematics/chain/chain.h"
#include "machine/description.h"
#include "tests/machine/edited_file.h"
#include "tests/machine/scara.h"

namespace understudy::machine {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> axis_names(const MachineDescription& m) {
  std::vector<std::string> names;
  for (const auto& axis : m.chain().kinematics.chain.axes) names.push_back(axis.name);
  return names;
}

TEST(ChainDescription, TheArmIsTheOneOfItsFile) {
  const auto m = load_machine("arm");
  ASSERT_TRUE(m.is_chain());
  EXPECT_THAT(axis_names(m), ElementsAre("j1", "j2", "j3", "j4", "j5", "j6"));
  EXPECT_EQ(m.chain().kinematics.kind, "arm");
  EXPECT_DOUBLE_EQ(m.chain().kinematics.length_scale, 0.3);
  EXPECT_DOUBLE_EQ(m.chain().kinematics.condition_max, 200);
  EXPECT_DOUBLE_EQ(m.chain().kinematics.chain.axes[1].lower, from_deg(-45));
  EXPECT_DOUBLE_EQ(m.chain().kinematics.home[4], from_deg(55));
  // docs/reference.md#robot-arm: 0.36 arcmin in every joint; 3.6 degrees a turn of 8192 counts.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(m.chain().play[i], from_deg(0.36 / 60), 1e-15);
  EXPECT_NEAR(m.drives[0].step(), from_deg(3.6) / 8192, 1e-18);
  EXPECT_DOUBLE_EQ(m.drives[5].velocity_max, from_deg(420));
  EXPECT_FALSE(m.drives[1].self_locking);
  EXPECT_EQ(m.drives[0].stiffness, 0);
  double mass = 0;
  for (const Link& link : m.chain().links) mass += link.mass;
  EXPECT_NEAR(mass, 26.6, 1e-9);  // "about 27 kg in all"
  EXPECT_FALSE(m.has_microscope);
  EXPECT_TRUE(m.X_WB.translation().isApprox(Vec3(-0.45, 0, -0.2), 1e-12));
  // Ishak 2018, Motoman SV3X: 677 mm from the second axis to the wrist's flange... straight out,
  // docs/reference.md#robot-arm.
  EXPECT_NEAR(to_mm(0.15 + 0.26 + std::hypot(0.06, 0.26)), 676.8, 0.05);
}

TEST(ChainDescription, TheTableOfTheFiveAxisPrinterCarriesTheWork) {
  const auto m = load_machine("five-axis");
  ASSERT_TRUE(m.is_chain());
  EXPECT_THAT(axis_names(m), ElementsAre("x", "y", "z", "b", "c"));
  const auto& chain = m.chain().kinematics.chain;
  EXPECT_EQ(chain.axes[static_cast<std::size_t>(chain.work_axis)].name, "c");
  EXPECT_EQ(chain.axes[static_cast<std::size_t>(chain.axes[4].parent)].name, "b");
  EXPECT_NEAR(chain.axes[3].point.z(), -0.030, 1e-12);
  EXPECT_EQ(chain.axes[4].lower, -kinematics::kEndless);
  EXPECT_EQ(chain.axes[4].upper, kinematics::kEndless);
  EXPECT_TRUE(m.X_WB.isApprox(Pose::Identity(), 0));  // W moves with the table
  EXPECT_TRUE(m.X_BT_home.translation().isApprox(Vec3(0, 0, 0.05), 1e-12));
  EXPECT_DOUBLE_EQ(m.chain().play[0], 20e-6);
  EXPECT_NEAR(m.chain().play[3], from_deg(1.0 / 60), 1e-15);
  EXPECT_FALSE(m.drives[0].self_locking);
  EXPECT_TRUE(m.drives[2].self_locking);
  EXPECT_TRUE(m.drives[3].self_locking);
  EXPECT_NEAR(m.drives[0].lead, 0.040, 1e-15);
}

TEST(ChainDescription, TheFinishingStageCutsAndDoesNotPrint) {
  const auto m = load_machine("finishing");
  ASSERT_TRUE(m.is_chain());
  EXPECT_THAT(axis_names(m), ElementsAre("z", "c", "x", "y", "yaw", "pitch"));
  EXPECT_FALSE(m.tool.prints());
  EXPECT_DOUBLE_EQ(m.tool.flat_diameter, 0.003);
  EXPECT_EQ(m.gap.aim, 0);
  EXPECT_FALSE(m.make_mechanism()->follows_spin());
  EXPECT_TRUE(m.make_mechanism()->home().isApprox(m.X_BT_home, 1e-12));
}

TEST(ChainDescription, DrivesReadZeroWhereAChainsAxesAreZero) {
  for (const char* name : {"arm", "five-axis", "finishing"})
    for (const double zero : load_machine(name).drive_zero()) EXPECT_EQ(zero, 0);
}

using ListedChain = EditedFile;

TEST_F(ListedChain, StandsAsItsLinesSay) {
  const auto m = load_machine(write(kScara));
  ASSERT_TRUE(m.is_chain());
  const auto& chain = m.chain().kinematics.chain;
  EXPECT_THAT(axis_names(m), ElementsAre("shoulder", "elbow", "wrist", "quill"));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(chain.axes[static_cast<std::size_t>(i)].parent, i - 1);
  EXPECT_EQ(chain.tool_axis, 3);
  EXPECT_EQ(chain.work_axis, -1);
  EXPECT_FALSE(chain.axes[3].angle);
  EXPECT_DOUBLE_EQ(m.chain().friction[0], 0.2);
  EXPECT_DOUBLE_EQ(m.chain().friction[3], 0);
  // Two links of 200 mm at +40 and -40 degrees from the x axis, the quill 50 mm down from 100 mm.
  const Vec3 tip(2 * 0.2 * std::cos(from_deg(40)) - 0.25, 0, 0.05);
  EXPECT_LT(((m.X_WB * m.X_BT_home).translation() - tip).norm(), 1e-15);
  EXPECT_TRUE((m.X_WB * m.X_BT_home).linear().isApprox(Mat3::Identity(), 1e-14));
  // tip_play: (mm per rad of each turn about z at home) x 0.5 arcmin, and 20 um of the quill.
  const double elbow =
      (tip - Vec3(0.2 * std::cos(from_deg(40)) - 0.25, 0.2 * std::sin(from_deg(40)), 0.05)).norm();
  const double turns = 2 * 0.2 * std::cos(from_deg(40)) + elbow;
  EXPECT_NEAR(m.tip_play(), turns * from_deg(0.5 / 60) + 20e-6, 1e-12);
}

TEST_F(ListedChain, ToolAndWorkMayBeCarriedByAnyAxisOrTheFrame) {
  const std::string moved = edited(kScara, "geometry", "work_carried_by: frame", "work_carried_by: shoulder");
  const std::string base = "base_mm: [-250, 0, 0]\n  base_turn_deg: 0\n  ";
  const auto m = load_machine(write(edited(moved, "geometry", base, "")));
  EXPECT_EQ(m.chain().kinematics.chain.work_axis, 0);
  EXPECT_TRUE(m.X_WB.isApprox(Pose::Identity(), 0));  // what moves the work carries W
  EXPECT_THAT([&] { load_machine(write(moved)); },
              ::testing::ThrowsMessage<InputError>(
                  ::testing::AllOf(::testing::HasSubstr(":4:"), ::testing::HasSubstr("geometry.base_mm"))));
}

TEST_F(ListedChain, AnElasticDriveKnowsItsRotor) {
  const auto m = load_machine(
      write(edited(edited(kScara, "- name: shoulder", "microsteps: 1,",
                          "microsteps: 1, stiffness_nm_per_rad: 5000, resonance_hz: 50, damping_ratio: 0.2,"),
                   "- name: quill", "microsteps: 16,",
                   "microsteps: 16, stiffness_n_per_um: 20, resonance_hz: 200, damping_ratio: 0.1,")));
  EXPECT_DOUBLE_EQ(m.drives[0].stiffness, 5000);
  EXPECT_DOUBLE_EQ(m.drives[0].resonance, 50);
  EXPECT_DOUBLE_EQ(m.drives[0].damping_ratio, 0.2);
  EXPECT_NEAR(m.drives[0].rotor(), 5000 / std::pow(2 * 3.14159265358979 * 50, 2), 1e-9);  // k / (2 pi f)^2
  EXPECT_DOUBLE_EQ(m.drives[3].stiffness, 20e6);
  EXPECT_EQ(m.drives[1].rotor(), 0);
}

}  // namespace
}  // namespace understudy::machine
