// The section `calibration`: what the controller then knows, what it does not touch, and what is refused.
#include "machine/file/calibration_section.h"

#include <regex>

#include "core/file/read_file.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kDigits = 1e-12;  // [m]: the file has 9 decimals of a millimetre

Vec3 some(Random& random, double sigma) { return sigma * normal_vec3(random); }

/// The shipped hexapod as a calibration may have found it.
MachineDescription calibrated_hexapod() {
  MachineDescription m = load_machine("hexapod");
  Random random(3, "calibration section test");
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    m.hexapod().geometry.base_joint[i] += some(random, 0.5e-3);
    m.hexapod().geometry.platform_joint[i] += some(random, 0.5e-3);
    m.hexapod().geometry.length_offset[i] += 0.5e-3 * random.normal();
  }
  m.hexapod().geometry.deviation += 0.3e-3;
  m.calibration = {"maximum_likelihood", "poses \"3\".csv", std::string(64, '0'), 24, 17.5e-6};
  return m;
}

MachineDescription calibrated_arm() {
  MachineDescription m = load_machine("arm");
  Random random(4, "calibration section test");
  kinematics::ChainDescription& k = m.chain().kinematics;
  k.design = k.chain;
  for (auto& axis : k.chain.axes) {
    axis.point += some(random, 0.5e-3);
    axis.direction = (exp_rotation(some(random, 1e-3)) * axis.direction).normalized();
  }
  k.chain.X_OT_zero.translation() += some(random, 0.5e-3);
  k.chain.X_OS_zero = make_pose(Mat3(exp_rotation(some(random, 1e-3))), some(random, 1e-3));
  m.calibration = {"maximum_likelihood", "arm.csv", std::string(64, '0'), 40, 30e-6};
  return m;
}

class CalibrationSection : public EditedFile {
 protected:
  MachineDescription back(const MachineDescription& machine) const {
    const auto path = folder_ / "calibrated.yaml";
    write_calibrated(machine, path);
    return load_machine(path.string());
  }
  std::string text_of(const MachineDescription& machine) const {
    return with_section(read_file(machine.file), calibration_section(machine));
  }
  std::string refusal(const std::string& after, const std::string& from, const std::string& to) {
    return error_of(edited(text_of(calibrated_hexapod()), after, from, to));
  }
};

TEST_F(CalibrationSection, ReplacesTheGeometryThatTheControllerUses) {
  const MachineDescription drawn = load_machine("hexapod"), m = calibrated_hexapod(), read = back(m);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    EXPECT_LT((read.hexapod().geometry.base_joint[i] - m.hexapod().geometry.base_joint[i]).norm(), kDigits);
    EXPECT_LT((read.hexapod().geometry.platform_joint[i] - m.hexapod().geometry.platform_joint[i]).norm(),
              kDigits);
    EXPECT_NEAR(read.drive_zero()[i], m.hexapod().geometry.length_offset[i], kDigits);
    EXPECT_EQ(read.hexapod().design.base_joint[i], drawn.hexapod().geometry.base_joint[i]);
    // Studs were made as drawn: they are not what was measured.
    EXPECT_EQ(read.hexapod().joints.stud_axis[i], drawn.hexapod().joints.stud_axis[i]);
  }
  EXPECT_NEAR(read.hexapod().geometry.deviation, m.hexapod().geometry.deviation, kDigits);
  EXPECT_TRUE(read.X_BT_home.isApprox(drawn.X_BT_home, 0));
  ASSERT_TRUE(read.calibration);
  EXPECT_EQ(read.calibration->measurements, "poses \"3\".csv");
  EXPECT_EQ(read.calibration->poses, 24);
  EXPECT_NEAR(read.calibration->tip_sigma, 17.5e-6, 1e-9);
  EXPECT_FALSE(drawn.calibration);
}

TEST_F(CalibrationSection, LeavesTheRestOfTheFileAsItIsAndReplacesAnOlderOne) {
  const MachineDescription m = calibrated_hexapod();
  const std::string original = read_file(m.file), once = text_of(m);
  EXPECT_THAT(once, StartsWith(original));
  EXPECT_EQ(with_section(once, calibration_section(m)), once);
  // Also where it does not stand last.
  const std::string middle = once + "\n# of the table\nextra:\n  key: 1\n";
  const std::string moved = with_section(middle, calibration_section(m));
  EXPECT_THAT(moved, HasSubstr("# of the table\nextra:\n  key: 1\n"));
  EXPECT_EQ(moved.find("\ncalibration:"), moved.rfind("\ncalibration:"));
}

TEST_F(CalibrationSection, ACalibratedArmReachesPosesByItsMeasuredAxes) {
  const MachineDescription m = calibrated_arm(), read = back(m);
  const auto mechanism = read.make_mechanism();
  const kinematics::Chain& truth = m.chain().kinematics.chain;
  Random random(5, "calibrated arm");
  for (int k = 0; k < 50; ++k) {
    const Pose X = make_pose(Mat3(exp_rotation(some(random, 0.1)) * read.X_BT_home.linear()),
                             Vec3(read.X_BT_home.translation() + some(random, 0.03)));
    std::array<double, 6> axes{};
    ASSERT_EQ(mechanism->inverse(X, {}, axes), kinematics::SolveStatus::ok);
    // 1e-12 of the solver, and the file's digits at an arm's length.
    EXPECT_LT((kinematics::forward(truth, axes).translation() - X.translation()).norm(), 1e-10);
  }
}

TEST_F(CalibrationSection, IsRefusedWhereItBelongsToAnotherMachine) {
  EXPECT_THAT(refusal("calibration:", "base_joint_mm: [5", "base_joint_mm: [9"),
              AllOf(HasSubstr("base joint 1 is"), HasSubstr("another machine?"), HasSubstr(kInThatLine)));
  EXPECT_THAT(refusal("calibration:", "length_offset_mm: 1", "length_offset_mm: 2"),
              HasSubstr("length offset 1 is"));
  EXPECT_THAT(refusal("calibration:", "  poses: 24\n", ""), HasSubstr("key 'calibration.poses' is missing"));
  EXPECT_THAT(refusal("calibration:", "poses: 24", "poses: 24\n  noses: 2"),
              HasSubstr("unknown key 'calibration.noses'"));
}

// The line belongs to a file that is never written.
TEST_F(CalibrationSection, ACalibrationThatWouldBeRefusedIsNotWrittenAndNamesTheFileAlone) {
  MachineDescription m = calibrated_hexapod();
  m.hexapod().geometry.base_joint[0].x() += 50e-3;
  const auto path = folder_ / "far.yaml";
  try {
    write_calibrated(m, path);
    FAIL() << "written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                StartsWith(path.string() + ": the calibrated machine would be refused: base joint 1 is"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

// A zero of 4 deg at the shoulder takes the tool of an arm much farther than any part is from its drawing.
TEST_F(CalibrationSection, ZerosOfAnArmMaySwingItsToolAway) {
  MachineDescription m = calibrated_arm();
  kinematics::Chain& chain = m.chain().kinematics.chain;
  const Mat3 turn = exp_rotation(4 * kDegree * chain.axes[1].direction);
  const Vec3 centre = chain.axes[1].point;
  const auto swing = [&](const Vec3& p) { return Vec3(centre + turn * (p - centre)); };
  for (std::size_t i = 2; i < chain.axes.size(); ++i) {
    chain.axes[i].point = swing(chain.axes[i].point);
    chain.axes[i].direction = turn * chain.axes[i].direction;
  }
  const Vec3 tool = chain.X_OT_zero.translation();
  chain.X_OT_zero = make_pose(Mat3(turn * chain.X_OT_zero.linear()), swing(tool));
  ASSERT_GT((chain.X_OT_zero.translation() - tool).norm(), kFarFromDrawing);
  EXPECT_NO_THROW(back(m));
  chain.X_OT_zero.translation() += Vec3(0, 0, 0.3);
  EXPECT_THAT(error_of(text_of(m)), HasSubstr("another machine?"));
}

TEST_F(CalibrationSection, ListsEveryStrutOnce) {
  const std::string whole = text_of(calibrated_hexapod());
  const auto last = whole.rfind("    - {base_joint_mm");
  EXPECT_THAT(error_of(whole.substr(0, last)), HasSubstr("lists 5 struts, not 6"));
  EXPECT_THAT(error_of(whole + whole.substr(last)), HasSubstr("lists more than 6 struts"));
}

TEST_F(CalibrationSection, MustLeaveHomeWithinTheLimits) {
  MachineDescription m = calibrated_hexapod();
  m.hexapod().limits.strut_max = 0.19;  // does not matter: the file's own limits do
  EXPECT_NO_THROW(back(m));
  // Base joints 24 mm lower, ball joints 24 mm higher: struts at home are some 45 mm shorter than 189 mm,
  // below 170.
  for (auto& b : m.hexapod().geometry.base_joint) b.z() -= 24e-3;
  for (auto& a : m.hexapod().geometry.platform_joint) a.z() += 24e-3;
  try {
    back(m);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("calibrated.yaml"), HasSubstr("home cannot be reached")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / ".calibrated.part.yaml"));
}

TEST_F(CalibrationSection, FilesBesideItAndLinksToItStay) {
  namespace fs = std::filesystem;
  std::ofstream(folder_ / ".calibrated.part.yaml") << "mine";
  fs::create_symlink("elsewhere.yaml", folder_ / "calibrated.yaml");
  EXPECT_NO_THROW(back(calibrated_hexapod()));
  EXPECT_EQ(read_file(folder_ / ".calibrated.part.yaml"), "mine");
  EXPECT_TRUE(fs::is_symlink(folder_ / "calibrated.yaml"));
  EXPECT_TRUE(fs::is_regular_file(folder_ / "elsewhere.yaml"));
}

TEST_F(CalibrationSection, IsRefusedForMachinesWhoseInverseNeedsTheDrawing) {
  const std::string section = calibration_section(calibrated_arm());
  EXPECT_THAT(error_of(with_section(read_file(load_machine("five-axis").file), section)),
              HasSubstr("only hexapod, arm, chain can be calibrated"));
}

TEST_F(CalibrationSection, NamesTheAxisThatIsNotThere) {
  const std::string text = text_of(calibrated_arm());
  EXPECT_THAT(error_of(edited(text, "calibration:", "axis: \"j3\"", "axis: \"j4\"")),
              AllOf(HasSubstr("is 'j4', where axes has 'j3'"), HasSubstr(kInThatLine)));
  EXPECT_THAT(error_of(edited(text, "tool_quaternion", "[0.", "[0.1")), HasSubstr("has length"));
}

TEST_F(CalibrationSection, IsExplainedKeyByKey) {
  const std::string document = read_file(UNDERSTUDY_SOURCE_DIR "/docs/machine-description.md");
  const std::regex key("(?:^|[\\n{,]) *([a-z][a-z0-9_]*):");
  for (const MachineDescription& m : {calibrated_hexapod(), calibrated_arm()}) {
    const std::string section = calibration_section(m);
    for (auto it = std::sregex_iterator(section.begin(), section.end(), key); it != std::sregex_iterator();
         ++it)
      EXPECT_THAT(document, HasSubstr("`" + it->str(1) + "`"));
  }
}

}  // namespace
}  // namespace understudy::machine
