#include "machine/description.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kShipped = UNDERSTUDY_SOURCE_DIR "/models/hexapod/machine.yaml";

class MachineFile : public testing::Test {
 protected:
  fs::path write(const std::string& text) {
    const fs::path path = folder_ / "machine.yaml";
    std::ofstream(path) << text;
    return path;
  }

  /// The shipped file with one piece of text replaced; the first line of the piece is `line_`.
  std::string edited(const std::string& from, const std::string& to) {
    std::string text = read_file(kShipped);
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from << " is not in the shipped file";
    line_ =
        1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    return text.replace(at, from.size(), to);
  }

  std::string error_of_text(const std::string& text) {
    const fs::path path = write(text);
    try {
      load_machine(path.string());
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "more than one line";
      EXPECT_THAT(error.what(), HasSubstr("machine.yaml"));
      return error.what();
    }
    return "accepted";
  }
  std::string error_of(const std::string& from, const std::string& to) {
    return error_of_text(edited(from, to));
  }
  std::string at_line(int offset = 0) const { return "machine.yaml:" + std::to_string(line_ + offset) + ":"; }

  const TemporaryFolder folder_;
  int line_ = 0;
};

TEST(MachineDescription, ShippedHexapodIsMachineG4) {
  const auto m = load_machine("hexapod");
  EXPECT_EQ(m.name, "hexapod");
  EXPECT_EQ(m.sha256, sha256_hex(read_file(kShipped)));
  // docs/reference.md#machine-g4: every strut of G4 is 189.29 mm at home with dev 0; dev 15 makes it
  // sqrt(189.29^2 - 15^2).
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    const Vec3 d = m.hexapod().geometry.base_joint[i] - m.X_BT_home * m.hexapod().geometry.platform_joint[i];
    EXPECT_NEAR(to_mm(d.norm()), 189.2924, 1e-4);
  }
  kinematics::StrutLengths lengths;
  ASSERT_EQ(kinematics::inverse(m.hexapod().geometry, m.X_BT_home, lengths), kinematics::SolveStatus::ok);
  EXPECT_NEAR(to_mm(lengths[0]), 188.6972, 1e-4);
  // Ball joints 16 mm apart or more, base joints 45 mm or more (docs/reference.md#machine-g4, to the
  // millimetre).
  EXPECT_NEAR(to_mm((m.hexapod().geometry.platform_joint[0] - m.hexapod().geometry.platform_joint[1]).norm()),
              2 * 29 * std::sin(from_deg(17)), 1e-9);
  EXPECT_GT(to_mm((m.hexapod().geometry.base_joint[1] - m.hexapod().geometry.base_joint[2]).norm()), 45);
  EXPECT_TRUE((m.X_WB * m.X_BT_home).translation().isApprox(Vec3(0, 0, 0.05), 1e-12));
  EXPECT_NEAR(m.drives[0].lead, kInch / 16, 1e-12);
  EXPECT_NEAR(m.drives[0].step(), kInch / 16 / 3200, 1e-15);
  EXPECT_DOUBLE_EQ(m.hexapod().play.screw_nut, 50e-6);
  EXPECT_DOUBLE_EQ(m.microscope.exposure, 0.01);
  EXPECT_DOUBLE_EQ(m.laser.wavelength, 650e-9);
  EXPECT_DOUBLE_EQ(m.orientation_velocity, from_deg(60));
}

TEST(MachineDescription, TheDocumentExplainsEveryKeyOfTheShippedFile) {
  const std::string yaml = read_file(kShipped);
  const std::string document = read_file(UNDERSTUDY_SOURCE_DIR "/docs/machine-description.md");
  const std::regex key("(?:^|[\\n{,]) *([a-z][a-z0-9_]*):");
  int keys = 0;
  for (auto it = std::sregex_iterator(yaml.begin(), yaml.end(), key); it != std::sregex_iterator();
       ++it, ++keys)
    EXPECT_THAT(document, HasSubstr("`" + it->str(1) + "`"));
  EXPECT_GT(keys, 80);
}

TEST(MachineDescription, MechanismRestsAtHome) {
  const auto m = load_machine("hexapod");
  const auto mechanism = m.make_mechanism();
  EXPECT_EQ(mechanism->axis_count(), 6);
  EXPECT_TRUE(mechanism->home().isApprox(m.X_BT_home, 1e-12));
}

TEST(MachineDescription, KnowsTheShippedMachines) {
  EXPECT_THAT(machine_names(), testing::Contains("hexapod"));
}

TEST(MachineDescription, AnUnknownMachineListsTheKnownOnes) {
  try {
    load_machine("hexapot");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("unknown machine 'hexapot', did you mean 'hexapod'?"),
                                    HasSubstr("known machines: ")));
  }
}

TEST_F(MachineFile, ModelsFolderFollowsTheEnvironment) {
  fs::create_directory(folder_ / "bench");
  fs::copy_file(kShipped, folder_ / "bench" / "machine.yaml");
  ::setenv("UNDERSTUDY_MODELS", folder_.path().c_str(), 1);
  const auto names = machine_names();
  const auto m = load_machine("bench");
  ::unsetenv("UNDERSTUDY_MODELS");
  EXPECT_EQ(names, std::vector<std::string>{"bench"});
  EXPECT_EQ(m.file, folder_ / "bench" / "machine.yaml");
}

TEST_F(MachineFile, AFolderMeansItsMachineFile) {
  write(read_file(kShipped));
  EXPECT_EQ(load_machine(folder_.path().string() + "/").name, "hexapod");
}

TEST_F(MachineFile, AMisspeltKeyNamesTheNearestKnownOne) {
  const std::string error = error_of("  microsteps: 16", "  microstep: 16");
  EXPECT_THAT(error, AllOf(HasSubstr("unknown key 'drive.microstep', did you mean 'microsteps'?"),
                           HasSubstr(at_line())));
}

TEST_F(MachineFile, AKeyInAnotherUnitIsUnknown) {
  EXPECT_THAT(error_of("  lead_mm: 1.5875", "  lead_m: 0.0015875"),
              HasSubstr("unknown key 'drive.lead_m', did you mean 'lead_mm'?"));
}

TEST_F(MachineFile, AnAdditionalKeyIsRefused) {
  const std::string error = error_of("  microsteps: 16\n", "  microsteps: 16\n  wobble_um: 3\n");
  EXPECT_THAT(error, AllOf(HasSubstr("unknown key 'drive.wobble_um'"), HasSubstr(at_line(1))));
}

TEST_F(MachineFile, AMisspeltSectionNamesTheNearestKnownOne) {
  EXPECT_THAT(error_of("\nlaser:", "\nlazer:"), HasSubstr("unknown key 'lazer', did you mean 'laser'?"));
}

TEST_F(MachineFile, AMissingKeyIsNamed) {
  EXPECT_THAT(error_of("  steps_per_turn: 200\n", ""), HasSubstr("key 'drive.steps_per_turn' is missing"));
  EXPECT_THAT(error_of("table:\n  size_mm: [200, 200, 10]        # its top is z = 0\n", ""),
              HasSubstr("key 'table' is missing"));
}

TEST_F(MachineFile, AKeyGivenTwiceIsRefused) {
  const std::string error = error_of("  lead_mm: 1.5875\n", "  lead_mm: 1.5875\n  lead_mm: 2\n");
  EXPECT_THAT(error, AllOf(HasSubstr("drive.lead_mm is given twice"), HasSubstr(at_line(1))));
}

// It goes into files of HAL, where a line of its own is run.
TEST_F(MachineFile, ANameOfTwoLinesIsRefused) {
  const std::string error = error_of("name: hexapod", "name: \"x\\nloadusr touch /tmp/x\"");
  EXPECT_THAT(error, AllOf(HasSubstr(at_line()), HasSubstr("a name is one line")));
}

TEST_F(MachineFile, MetresUnderAMillimetreKeyAreOutsideItsRange) {
  const std::string error = error_of("lead_mm: 1.5875", "lead_mm: 1.5875e-3");
  EXPECT_THAT(error,
              AllOf(HasSubstr("drive.lead_mm is 0.0015875 mm, outside 0.1 to 100 mm"), HasSubstr(at_line())));
}

TEST_F(MachineFile, ANegativePlayIsRefusedWithItsLimit) {
  EXPECT_THAT(error_of("screw_nut_um: 50", "screw_nut_um: -50"),
              HasSubstr("play.screw_nut_um is -50 um, outside 0 to 2000 um"));
}

TEST_F(MachineFile, TextWhereANumberBelongsIsRefused) {
  EXPECT_THAT(error_of("lead_mm: 1.5875", "lead_mm: 1.5875 mm"),
              HasSubstr("drive.lead_mm is '1.5875 mm', where a number in mm is expected"));
  EXPECT_THAT(error_of("lead_mm: 1.5875", "lead_mm:"), HasSubstr("drive.lead_mm is empty"));
  EXPECT_THAT(error_of("lead_mm: 1.5875", "lead_mm: [1.5875]"), HasSubstr("drive.lead_mm is a list"));
}

TEST_F(MachineFile, NumbersThatAreNotFiniteAreRefused) {
  for (const char* value : {".nan", ".inf", "-.inf"})
    EXPECT_THAT(error_of("lead_mm: 1.5875", std::string("lead_mm: ") + value),
                HasSubstr(std::string("drive.lead_mm is ") + value + ", not finite"));
  EXPECT_THAT(error_of("lead_mm: 1.5875", "lead_mm: 1e999"), Not(HasSubstr("accepted")));
}

TEST_F(MachineFile, AHalfMicrostepIsRefused) {
  EXPECT_THAT(error_of("microsteps: 16", "microsteps: 16.5"),
              HasSubstr("drive.microsteps is 16.5, not a whole number"));
}

TEST_F(MachineFile, AVectorOfTwoIsRefused) {
  EXPECT_THAT(error_of("home_tip_mm: [0, 0, 50]", "home_tip_mm: [0, 50]"),
              HasSubstr("geometry.home_tip_mm is a list of 2, where a list of 3 numbers is expected"));
}

TEST_F(MachineFile, ASectionThatIsANumberIsRefused) {
  EXPECT_THAT(error_of("play:\n  screw_nut_um: 50\n  ball_joint_um: 25\n", "play: 50\n"),
              HasSubstr("play is '50', where keys with values are expected"));
}

TEST_F(MachineFile, AnUnknownMechanismOrShapeListsTheKnownOnes) {
  EXPECT_THAT(error_of("mechanism: hexapod", "mechanism: hexapode"), HasSubstr("not one of hexapod"));
  EXPECT_THAT(error_of("shape: frustum", "shape: cone"), HasSubstr("not one of frustum, cylinder, box"));
}

TEST_F(MachineFile, AnInvertedStrutRangeIsRefused) {
  EXPECT_THAT(error_of("strut_min_mm: 170", "strut_min_mm: 240"),
              HasSubstr("limits.strut_min_mm is 240 mm, not below strut_max_mm of 240 mm"));
}

TEST_F(MachineFile, AHomeBeyondTheStrutsIsRefusedNamingTheStrut) {
  EXPECT_THAT(error_of("home_tip_mm: [0, 0, 50]", "home_tip_mm: [0, 0, -40]"),
              AllOf(HasSubstr("home cannot be reached: strut 1 is "), HasSubstr("longer than 240")));
}

TEST_F(MachineFile, AStrutWithoutLengthIsRefused) {
  const std::string text = edited("base_height_mm: 256", "base_height_mm: 75");
  EXPECT_THAT(error_of_text(text),
              HasSubstr("home cannot be reached"));  // flat: joints far apart, but too near
  std::string flat = text;
  flat.replace(flat.find("base_radius_mm: 80"), 18, "base_radius_mm: 29");
  flat.replace(flat.find("base_pair_half_angle_deg: 43"), 28, "base_pair_half_angle_deg: 17");
  EXPECT_THAT(error_of_text(flat), HasSubstr("strut 1 has no length at home: its joints are 0.000 mm apart"));
}

TEST_F(MachineFile, CoincidentJointsAreRefused) {
  EXPECT_THAT(error_of("  base_pair_half_angle_deg: 43", "  base_pair_half_angle_deg: 0"),
              HasSubstr("base joints 1 and 2 are 0.000 mm apart"));
  EXPECT_THAT(error_of("platform_pair_half_angle_deg: 43", "platform_pair_half_angle_deg: 60"),
              HasSubstr("platform joints 1 and 2 are 0.000 mm apart"));
}

TEST_F(MachineFile, AGapBandUpsideDownIsRefused) {
  EXPECT_THAT(error_of("accepted_min_mm: 0.10", "accepted_min_mm: 0.30"),
              HasSubstr("gap.accepted_min_mm is 0.3 mm, not below accepted_max_mm of 0.2 mm"));
}

TEST_F(MachineFile, AnAimOutsideTheBandIsRefused) {
  EXPECT_THAT(error_of("aim_mm: 0.13", "aim_mm: 0.25"),
              HasSubstr("gap.aim_mm is 0.25 mm, not between 0.1 and 0.2 mm"));
}

TEST_F(MachineFile, AStandoffInsideTheBandIsRefused) {
  EXPECT_THAT(error_of("standoff_mm: 2", "standoff_mm: 0.15"),
              HasSubstr("gap.standoff_mm is 0.15 mm, not above"));
}

TEST_F(MachineFile, ABeamIntoTheNozzleIsRefused) {
  EXPECT_THAT(error_of("crosses_tip_plane_mm: 1.1", "crosses_tip_plane_mm: 0.4"),
              HasSubstr("within the nozzle's flat of radius 0.5 mm"));
}

TEST_F(MachineFile, AMicroscopeThatLooksBesideTheDotIsRefused) {
  EXPECT_THAT(error_of("looks_at_mm: [0, 1.1, 0]", "looks_at_mm: [0, 20, 0]"),
              HasSubstr("the microscope does not see the dot at the gap aimed at, 0.13 mm"));
}

TEST_F(MachineFile, AMicroscopeWithMorePixelsThanCanBeDrawnIsRefused) {
  EXPECT_THAT(error_of("width_px: 640", "width_px: 8001"), HasSubstr("outside 16 to 8000 px"));
  EXPECT_THAT(error_of("width_px: 640\n  height_px: 480", "width_px: 8000\n  height_px: 2001"),
              HasSubstr("the sensor of the microscope has 8000 x 2001 px, more than 16000000"));
}

TEST_F(MachineFile, ANozzleWithoutAFlatIsRefused) {
  EXPECT_THAT(error_of("flat_diameter_mm: 1.0", "flat_diameter_mm: 0.4"),
              HasSubstr("tool.flat_diameter_mm is 0.4 mm, not wider than the bore of 0.4 mm"));
}

TEST_F(MachineFile, AnInertiaThatNoBodyHasIsRefused) {
  EXPECT_THAT(error_of("[288, 288, 327]", "[288, 288, 600]"), HasSubstr("more than the sum 576 kg mm^2"));
}

TEST_F(MachineFile, TextThatIsNotYamlIsRefusedWithItsLine) {
  EXPECT_THAT(error_of("drive:\n", "drive: [\n"), AllOf(HasSubstr("not YAML"), HasSubstr("machine.yaml:")));
  EXPECT_THAT(error_of_text(std::string("\x7f"
                                        "ELF\0\0\1",
                                        7)),
              Not(HasSubstr("accepted")));
}

TEST_F(MachineFile, AnEmptyFileIsRefused) {
  EXPECT_THAT(error_of_text(""), HasSubstr("the file is empty"));
  EXPECT_THAT(error_of_text("# nothing\n"), Not(HasSubstr("accepted")));
}

TEST_F(MachineFile, AFileThatCannotBeReadIsNamed) {
  try {
    load_machine((folder_ / "absent.yaml").string());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("cannot read"), HasSubstr("absent.yaml")));
  }
}

}  // namespace
}  // namespace understudy::machine
