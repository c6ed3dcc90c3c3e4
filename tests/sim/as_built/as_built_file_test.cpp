// Built machines in files: what is written reads back, what is not told stays, mistakes have a line.
#include "sim/as_built/as_built_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Numbers are written with all digits; a unit that is divided out and multiplied in again costs two roundings
// of lengths below half a metre and of angles below 0.01 rad.
constexpr double kLength = 2e-16;  // [m]
constexpr double kAngle = 1e-17;   // [rad]

class AsBuiltFile : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(path_) << text;
    return path_;
  }
  std::string error_of(const machine::MachineDescription& machine, const std::string& text) {
    try {
      make_as_built(machine, write(text), 1);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << "more than one line";
      return what;
    }
    return "accepted";
  }

  const TemporaryFolder folder_;
  const std::string path_ = (folder_ / "built.yaml").string();
  const machine::MachineDescription hexapod_ = machine::load_machine("hexapod");
  const machine::MachineDescription five_axis_ = machine::load_machine("five-axis");
};

TEST_F(AsBuiltFile, AHexapodThatIsWrittenReadsBackAsTheSame) {
  AsBuilt built = make_as_built(hexapod_, "manufactured", 11);
  built.hexapod.deviation = 15.25e-3;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    built.nut_play[i] = 1e-6 * static_cast<double>(7 + i) / 3;
    built.ball_play[i] = 1e-6 * static_cast<double>(i) / 7;
  }
  const AsBuilt back = make_as_built(hexapod_, write(write_as_built(built)), 1);
  EXPECT_EQ(back.source, path_);
  EXPECT_NEAR(back.hexapod.deviation, built.hexapod.deviation, kLength);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    EXPECT_LT((back.hexapod.base_joint[i] - built.hexapod.base_joint[i]).cwiseAbs().maxCoeff(), kLength);
    EXPECT_LT((back.hexapod.platform_joint[i] - built.hexapod.platform_joint[i]).cwiseAbs().maxCoeff(),
              kLength);
    EXPECT_NEAR(back.hexapod.length_offset[i], built.hexapod.length_offset[i], kLength);
    EXPECT_NEAR(back.nut_play[i], built.nut_play[i], 1e-20);
    EXPECT_NEAR(back.ball_play[i], built.ball_play[i], 1e-20);
  }
}

TEST_F(AsBuiltFile, AChainThatIsWrittenReadsBackAsTheSame) {
  for (const char* name : {"arm", "five-axis", "finishing"}) {
    const auto machine = machine::load_machine(name);
    const AsBuilt built = make_as_built(machine, "manufactured", 12);
    const AsBuilt back = make_as_built(machine, write(write_as_built(built)), 1);
    EXPECT_LT((back.chain.X_OT_zero.translation() - built.chain.X_OT_zero.translation()).norm(), kLength);
    for (std::size_t i = 0; i < built.chain.axes.size(); ++i) {
      EXPECT_LT((back.chain.axes[i].point - built.chain.axes[i].point).cwiseAbs().maxCoeff(), kLength);
      // Made of unit length once more: one rounding.
      EXPECT_LT((back.chain.axes[i].direction - built.chain.axes[i].direction).norm(), 4e-16);
      EXPECT_NEAR(back.axis_zero[i], built.axis_zero[i], built.chain.axes[i].angle ? kAngle : kLength);
      EXPECT_NEAR(back.axis_play[i], built.axis_play[i], 1e-18);
    }
  }
}

TEST_F(AsBuiltFile, AFileWrittenFromWhatWasReadIsTheSameFile) {
  const AsBuilt once =
      make_as_built(five_axis_, write(write_as_built(make_as_built(five_axis_, "sampled", 3))), 1);
  const std::string text = write_as_built(once);
  EXPECT_EQ(write_as_built(make_as_built(five_axis_, write(text), 1)), text);
}

TEST_F(AsBuiltFile, RodsAreToldWithTheirAxes) {
  const auto machine = machine::load_machine("delta");
  const AsBuilt drawn = make_as_built(machine, "manufactured", 4);
  const AsBuilt back = make_as_built(machine, write(write_as_built(drawn)), 1);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back.chain.rods[i], drawn.chain.rods[i], kLength);
  const AsBuilt one = make_as_built(machine, write("axes:\n  - {axis: b, rod_mm: 267.5}\n"), 1);
  EXPECT_NEAR(one.chain.rods[1], 267.5e-3, kLength);
  EXPECT_EQ(one.chain.rods[0], machine.chain().kinematics.chain.rods[0]);
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - {axis: b, rod_mm: 100}\n"), HasSubstr("rod_mm"));
}

TEST_F(AsBuiltFile, AHexapodChangesOnlyWhatTheFileNames) {
  const AsBuilt nominal = make_as_built(hexapod_, "nominal", 1);
  AsBuilt built = make_as_built(hexapod_, write("struts:\n  - {strut: 3, length_offset_mm: 170.5}\n"), 1);
  EXPECT_NEAR(built.hexapod.length_offset[2], 170.5e-3, kLength);
  built.hexapod.length_offset[2] = nominal.hexapod.length_offset[2];
  built.source = nominal.source;
  EXPECT_EQ(write_as_built(built), write_as_built(nominal));
  // Also when no strut is named at all.
  built = make_as_built(hexapod_, write("deviation_mm: 14.5\n"), 1);
  EXPECT_NEAR(built.hexapod.deviation, 14.5e-3, kLength);
  built.hexapod.deviation = nominal.hexapod.deviation;
  built.source = nominal.source;
  EXPECT_EQ(write_as_built(built), write_as_built(nominal));
}

TEST_F(AsBuiltFile, AChainChangesOnlyWhatTheFileNames) {
  const AsBuilt nominal = make_as_built(five_axis_, "nominal", 1);
  AsBuilt built =
      make_as_built(five_axis_, write("axes:\n  - {axis: b, zero_deg: 0.1, play_arcmin: 3}\n"), 1);
  EXPECT_NEAR(built.axis_zero[3], from_deg(0.1), kAngle);
  EXPECT_NEAR(built.axis_play[3], from_deg(0.05), kAngle);
  built.axis_zero[3] = 0;
  built.axis_play[3] = nominal.axis_play[3];
  built.source = nominal.source;
  EXPECT_EQ(write_as_built(built), write_as_built(nominal));
  built = make_as_built(five_axis_, write("tip_mm: [1, 2, 3]\n"), 1);
  EXPECT_LT((built.chain.X_OT_zero.translation() - Vec3(1e-3, 2e-3, 3e-3)).norm(), kLength);
  EXPECT_TRUE(built.chain.X_OT_zero.linear().isApprox(nominal.chain.X_OT_zero.linear(), 0));
}

TEST_F(AsBuiltFile, AnOffsetMayBeBelowZero) {
  auto machine = hexapod_;
  machine.hexapod().geometry.length_offset.fill(0);
  const AsBuilt built = make_as_built(machine, "manufactured", 5);
  EXPECT_LT(*std::min_element(built.hexapod.length_offset.begin(), built.hexapod.length_offset.end()), 0);
  EXPECT_NO_THROW(make_as_built(machine, write(write_as_built(built)), 1));
}

TEST_F(AsBuiltFile, MistakesOfAHexapodHaveLineAndKey) {
  EXPECT_THAT(error_of(hexapod_, "struts:\n  - {strut: 7}\n"),
              AllOf(HasSubstr("/built.yaml:2:"), HasSubstr("struts[1].strut is 7, outside 1 to 6")));
  EXPECT_THAT(error_of(hexapod_, "struts:\n  - {strut: 1, nut_play_um: -5}\n"),
              HasSubstr("struts[1].nut_play_um is -5 um, outside 0 to 2000 um"));
  EXPECT_THAT(error_of(hexapod_, "struts:\n  - {length_offset_mm: 170}\n"),
              HasSubstr("key 'struts[1].strut' is missing"));
  EXPECT_THAT(error_of(hexapod_, "struts:\n  - {strut: 1, base_join_mm: [0, 0, 0]}\n"),
              HasSubstr("unknown key 'struts[1].base_join_mm', did you mean 'base_joint_mm'?"));
  EXPECT_THAT(
      error_of(hexapod_, "struts:\n  - {strut: 1}\n  - {strut: 1}\n"),
      AllOf(HasSubstr("/built.yaml:3:"), HasSubstr("struts[2].strut names a part that was told before")));
  EXPECT_THAT(error_of(hexapod_, "axes:\n  - {axis: x}\n"), HasSubstr("unknown key 'axes'"));
}

TEST_F(AsBuiltFile, MistakesOfAChainHaveLineAndKey) {
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - {axis: a}\n"),
              AllOf(HasSubstr("/built.yaml:2:"), HasSubstr("axes[1].axis is 'a', not one of x, y, z, b, c")));
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - axis: b\n    direction: [0, 1.1, 0]\n"),
              HasSubstr("axes[1].direction is 1.1, outside -1 to 1"));
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - axis: b\n    direction: [0, 0.99, 0]\n"),
              AllOf(HasSubstr("/built.yaml:3:"), HasSubstr("axes[1].direction has length 0.9900000, not 1")));
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - {axis: b, zero_mm: 1}\n"),
              HasSubstr("unknown key 'axes[1].zero_mm'"));  // it turns
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - {axis: x, play_um: 1e9}\n"),
              HasSubstr("outside 0 to 2000 um"));
  EXPECT_THAT(error_of(five_axis_, "axes:\n  - {axis: b}\n  - {axis: b}\n"),
              HasSubstr("axes[2].axis names a part that was told before"));
  EXPECT_THAT(error_of(five_axis_, "struts:\n  - {strut: 1}\n"), HasSubstr("unknown key 'struts'"));
}

TEST_F(AsBuiltFile, ANameThatIsNoFileListsTheWords) {
  try {
    make_as_built(five_axis_, "sampeld", 1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("\"sampeld\""), HasSubstr("nominal, sampled, manufactured")));
  }
}

}  // namespace
}  // namespace understudy::sim
