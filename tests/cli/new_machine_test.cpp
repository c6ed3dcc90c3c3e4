#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kUrdf = UNDERSTUDY_SOURCE_DIR "/models/offset-wrist-arm/arm.urdf";

constexpr const char* kLine = R"(G21
G90
M82
M109 S210
G94
G0 X-10 Y0 Z5
G1 X-10 Y0 Z0.2 F300
G1 X10 Y0 E0.55 F900
G0 Z10
)";

void expect_one_line(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

TEST(NewMachine, OfAUrdfIsRehearsedAtOnceAndSaysWhatIsAssumed) {
  const Folder folder;
  const Outcome made = understudy("new-machine " + kUrdf + " -o " + (folder / "mine"));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(
      made.out,
      AllOf(HasSubstr("mine/machine.yaml: 6 axes from base to tool"),
            HasSubstr("assumed, to be measured: place, home, drives, play, tolerances, tool, motion")));
  const Outcome rehearsed =
      understudy(fmt::format("rehearse {} --machine {} --engine quasistatic --no-pictures --out {}",
                             folder.write("line.gcode", kLine), folder / "mine", folder / "out"));
  EXPECT_EQ(rehearsed.status, 0) << rehearsed.out << rehearsed.err;
  EXPECT_THAT(
      rehearsed.out,
      AllOf(HasSubstr("GO with warnings"),
            HasSubstr("nobody measured these figures of the machine: place (which poses can be reached")));
}

TEST(ExtendedNewMachine, OfEveryReadyKindIsReadAsItIs) {
  const Folder folder;
  for (const char* kind : {"hexapod", "trunnion-ac", "corexy", "arm-positioner"}) {
    const Outcome made = understudy(fmt::format("new-machine --kind {} -o {}", kind, folder / kind));
    EXPECT_EQ(made.status, 0) << made.err;
    const std::string text = read_file(folder / kind + "/machine.yaml");
    EXPECT_THAT(text, AllOf(HasSubstr("assumed: ["), HasSubstr("; assumed"),
                            HasSubstr(fmt::format("name: {}", kind))));
    EXPECT_EQ(understudy(fmt::format("schema machine --check {}/machine.yaml", folder / kind)).status, 0);
  }
}

TEST(NewMachine, BadInputIsOneLineAndLeavesNothing) {
  const Folder folder;
  const std::string there = folder / "there";
  fs::create_directories(there);
  const std::string no_limits = folder.write("free.urdf", R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  const std::string macro = folder.write(
      "macro.urdf", R"(<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:macro name="m"/></robot>)");
  const int before = folder.entries();
  const auto refused = [&](const std::string& words) {
    const Outcome outcome = understudy("new-machine " + words);
    expect_one_line(outcome);
    return outcome.err;
  };
  const std::string out = " -o " + (folder / "new");
  EXPECT_THAT(refused(kUrdf + " -o " + there), HasSubstr("is there already"));
  EXPECT_THAT(refused(no_limits + out), HasSubstr("joint 'j' is revolute and has no limit"));
  EXPECT_THAT(refused(macro + out), HasSubstr("is a xacro file, not expanded"));
  EXPECT_THAT(refused("--kind five-axes" + out), HasSubstr("did you mean 'five-axis'?"));
  EXPECT_THAT(refused("--kind arm " + kUrdf + out), HasSubstr("a URDF or --kind, one of them"));
  EXPECT_THAT(refused(out), HasSubstr("a URDF or --kind, one of them"));
  EXPECT_THAT(refused(kUrdf + " --tool-link tol" + out), HasSubstr("no link 'tol', did you mean 'tool'?"));
  EXPECT_THAT(refused(kUrdf + " -o " + (folder / "a/b/c")), HasSubstr("a/b"));
  EXPECT_EQ(folder.entries(), before);
}

/// A program named xacro that stands before all others.
class FakeXacro : public testing::Test {
 protected:
  void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }
  void install(const std::string& script) {
    fs::create_directories(folder_ / "bin");
    const std::string program = folder_.write("bin/xacro", "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", ((folder_ / "bin") + ":" + path_).c_str(), 1);
  }
  Outcome make() const {
    return understudy("new-machine " + folder_.write("arm.xacro", read_file(kUrdf)) + " -o " +
                      (folder_ / "new"));
  }
  Folder folder_;

 private:
  const std::string path_ = std::getenv("PATH") ? std::getenv("PATH") : "";
};

TEST_F(FakeXacro, IsRunAndItsUrdfTaken) {
  install("sed 's/name=\"j6\"/name=\"last\"/' \"$1\"\n");
  const Outcome made = make();
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(read_file(folder_ / "new/machine.yaml"), HasSubstr("- name: last"));
}

TEST_F(FakeXacro, ItsErrorIsOneLine) {
  install("echo 'No such package: kuka_resources' >&2\nexit 2\n");
  const Outcome made = make();
  expect_one_line(made);
  EXPECT_THAT(made.err, AllOf(HasSubstr("arm.xacro: xacro "), HasSubstr("No such package: kuka_resources")));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(FakeXacro, AnEmptyAnswerIsRefused) {
  install("exit 0\n");
  expect_one_line(make());
}

TEST_F(FakeXacro, WhereThereIsNoneTheErrorSaysWhatToInstall) {
  ::setenv("PATH", "/nowhere", 1);
  const Outcome made = make();
  expect_one_line(made);
  EXPECT_THAT(made.err, AllOf(HasSubstr("xacro is not installed"),
                              HasSubstr("which ROS brings, or expand the file where it is")));
}

}  // namespace
}  // namespace understudy::cli_test
