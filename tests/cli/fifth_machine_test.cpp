// A machine that nobody has written code for: a folder with a machine.yaml serves every command.
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"
#include "tests/machine/scara.h"

namespace understudy::cli_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FifthMachine : public testing::Test {
 protected:
  FifthMachine() {
    std::filesystem::create_directories(folder_.path() / "models/scara");
    folder_.write("models/scara/machine.yaml", kScara);
    ::setenv("UNDERSTUDY_MODELS", (folder_ / "models").c_str(), 1);
  }
  ~FifthMachine() override { ::unsetenv("UNDERSTUDY_MODELS"); }

  std::string program() const {
    return folder_.write("line.gcode",
                         "G21\nG90\nM82\nG94\nM109 S210\n"
                         "G0 X50 Y-5 Z5\nG1 X50 Y-5 Z0.2 F300\n"
                         "G1 X56 Y5 Z0.2 E0.4 F600\nG1 X62 Y-5 Z0.2 E0.8\nG0 Z10\n");
  }

  const Folder folder_;
};

TEST_F(FifthMachine, IsListedAmongTheMachines) {
  const Outcome outcome = understudy("machines");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("scara"));
}

TEST_F(FifthMachine, HasAxesAndPoses) {
  // Two links of 200 mm at +40 and -40 degrees, 250 mm before the work's origin.
  const auto poses =
      folder_.write("poses.csv", "x_mm,y_mm,z_mm,qw,qx,qy,qz\n56.417777,0,50,1,0,0,0\n56,0,900,1,0,0,0\n");
  const Outcome axes = understudy("axes --machine scara <" + poses);
  ASSERT_EQ(axes.status, 0) << axes.err;
  EXPECT_THAT(axes.out,
              AllOf(HasSubstr("shoulder_deg,elbow_deg,wrist_deg,quill_mm,status\n"), HasSubstr("\n40.0000"),
                    HasSubstr(",-80.0000"), HasSubstr(",-50.000000,ok\n"), HasSubstr("nan,nan,nan,nan,")));
  const auto table =
      folder_.write("axes.csv", "shoulder_deg,elbow_deg,wrist_deg,quill_mm\n0,90,-90,-110\n10,0,0,0\n");
  const Outcome back = understudy("poses --machine scara <" + table);
  ASSERT_EQ(back.status, 0) << back.err;
  EXPECT_THAT(back.out, AllOf(HasSubstr("\nnan,"), HasSubstr("\n143.923101,69.459271,100.000000,")));
}

class ExtendedFifthMachine : public FifthMachine {};

TEST_F(ExtendedFifthMachine, PrintsInBothKindsOfPlant) {
  for (const char* engine : {"mujoco", "quasistatic"}) {
    const std::string out = folder_ / engine;
    const Outcome outcome = understudy(
        "rehearse " + program() + " --machine scara --as-built nominal --engine " + engine + " --out " + out);
    EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
    EXPECT_THAT(read_file(out + "/summary.json"), HasSubstr("\"verdict\": \"go\""));
  }
}

TEST_F(FifthMachine, IsExportedForOtherPrograms) {
  const Outcome mjcf = understudy("export mjcf --machine scara -o " + (folder_ / "scara.xml"));
  ASSERT_EQ(mjcf.status, 0) << mjcf.err;
  EXPECT_THAT(read_file(folder_ / "scara.xml"), AllOf(HasSubstr("<joint name=\"elbow\" type=\"hinge\""),
                                                      HasSubstr("<joint name=\"quill\" type=\"slide\""),
                                                      HasSubstr("<joint name=\"quill play\"")));
  const Outcome urdf = understudy("export urdf --machine scara -o " + (folder_ / "scara.urdf"));
  ASSERT_EQ(urdf.status, 0) << urdf.err;
  EXPECT_THAT(read_file(folder_ / "scara.urdf"), HasSubstr("<joint name=\"elbow\""));
}

TEST_F(FifthMachine, MayAlsoBeNamedByItsPath) {
  ::unsetenv("UNDERSTUDY_MODELS");
  const auto table = folder_.write("axes.csv", "shoulder_deg,elbow_deg,wrist_deg,quill_mm\n0,0,0,0\n");
  const Outcome outcome = understudy("poses --machine " + (folder_ / "models/scara") + " <" + table);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\n150.000000,0.000000,100.000000,1.000000000,"));
}

}  // namespace
}  // namespace understudy::cli_test
