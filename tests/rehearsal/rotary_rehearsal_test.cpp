// Programs with B and C on the five-axis printer: the same run as their slides, and axes that go where the
// words say.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/program/rotary_words.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

struct Line {
  const char* command;
  Vec3 tip_mm;
  double b_deg, c_deg;
  const char* rest;
};
// C turns with the tool leant over, and B through 0 to its other side. No filament: nothing lies below.
const Line kLines[] = {{"G0", {2, 0, 48}, 0, 0, ""},
                       {"G0", {2, 0, 47}, 12, 0, ""},
                       {"G1", {3, 1, 47}, 12, 40, " F600"},
                       {"G1", {4, 1, 48}, 10, 50, ""},
                       {"G1", {3, -1, 47}, -4, 50, ""}};

std::string with_rotary_words() {
  std::string text = "G21 G90 M82\nG43.4\n";
  for (const Line& line : kLines)
    text += fmt::format("{} X{} Y{} Z{} B{} C{}{}\n", line.command, line.tip_mm.x(), line.tip_mm.y(),
                        line.tip_mm.z(), line.b_deg, line.c_deg, line.rest);
  return text;
}

class RotaryRehearsal : public testing::Test {
 protected:
  Record run(const std::string& text, const std::string& machine = "five-axis") const {
    std::ofstream(folder_ / "p.gcode") << text;
    RehearsalRequest request;
    request.program = (folder_ / "p.gcode").string();
    request.machine = machine;
    request.engine = "quasistatic";
    request.as_built = "nominal";
    request.keep_scene = false;
    request.compare_without_gap_control = false;
    return rehearse(request);
  }

  /// Slides that hold the tip of a line, by hand: back through both turns, about their axes.
  Vec3 slides_mm(const Line& line) const {
    const auto& p = machine_.chain().kinematics.parameters;
    const Vec3 b_axis = 1e3 * Vec3(p[0], 0, p[1]), c_axis = 1e3 * Vec3(p[2], p[3], 0);
    const Vec3 unturned =
        c_axis + Eigen::AngleAxisd(from_deg(-line.c_deg), Vec3::UnitZ()) * Vec3(line.tip_mm - c_axis);
    return b_axis + Eigen::AngleAxisd(from_deg(-line.b_deg), Vec3::UnitY()) * Vec3(unturned - b_axis);
  }

  std::string with_slides() const {
    std::string text = "G21 G90 M82\nG49\n";
    for (const Line& line : kLines) {
      const Vec3 p = slides_mm(line);
      text += fmt::format("{} X{:.12f} Y{:.12f} Z{:.12f} B{} C{}{}\n", line.command, p.x(), p.y(), p.z(),
                          line.b_deg, line.c_deg, line.rest);
    }
    return text;
  }

  void expect_same_trace(const Record& a, const Record& b) const {
    for (const Record* record : {&a, &b})
      for (const Finding& finding : record->findings)
        EXPECT_NE(finding.severity, Severity::error) << finding.message;
    ASSERT_EQ(a.trace.size(), b.trace.size());
    ASSERT_GT(a.trace.size(), 200u);
    for (std::size_t k = 0; k < a.trace.size(); ++k) {
      ASSERT_EQ(a.trace[k].time, b.trace[k].time);
      ASSERT_EQ(a.trace[k].line, b.trace[k].line);
      const Pose &P = a.trace[k].X_WT_programmed, &Q = b.trace[k].X_WT_programmed;
      // Poses told to 1e-15 m, planned to 1e-8 m of their way; turns of axes and of poses are timed on grids
      // of their own, to 1e-5 of a radian.
      ASSERT_LT((P.translation() - Q.translation()).norm(), 1e-8) << a.trace[k].time;
      ASSERT_LT((P.linear() - Q.linear()).norm(), 1e-5) << a.trace[k].time;
      // Rounding of the last digit may take a drive to the next microstep.
      for (std::size_t i = 0; i < 5; ++i)
        ASSERT_NEAR(a.trace[k].axes[i], b.trace[k].axes[i], 1.01 * machine_.drives[i].step())
            << "axis " << i << " at " << a.trace[k].time;
    }
  }

  const TemporaryFolder folder_;
  const machine::MachineDescription machine_ = machine::load_machine("five-axis");
};

TEST_F(RotaryRehearsal, RotaryWordsRunLikeTheirSlides) {
  expect_same_trace(run(with_rotary_words()), run(with_slides()));
}

TEST_F(RotaryRehearsal, TiltsRunLikeToolAxesWhereCDoesNotTurn) {
  std::string tilts = "G0 X2 Y0 Z48\n", axes = tilts;
  for (const double b : {8.0, 12.0, -5.0}) {
    tilts += fmt::format("G1 X{} B{} F600\n", 2 + b / 10, b);
    axes += fmt::format("G1 X{} I{:.17f} J0 K{:.17f} F600\n", 2 + b / 10, std::sin(from_deg(b)),
                        std::cos(from_deg(b)));
  }
  expect_same_trace(run(tilts), run(axes));
}

TEST_F(RotaryRehearsal, TheAxesEndWhereTheWordsOfMachineCoordinatesSay) {
  const Record record = run("G49\nG0 X1 Y2 Z50 B9\nG0 C100\nG0 C190.5 B8 X1.3 Z51\n");
  ASSERT_TRUE(record.go);
  ASSERT_FALSE(record.trace.empty());
  const double expected[] = {1.3e-3, 2e-3, 51e-3, from_deg(8), from_deg(190.5)};
  // A drive stands on the microstep nearest to its word.
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(record.trace.back().axes[i], expected[i], 0.51 * machine_.drives[i].step()) << "axis " << i;
}

TEST_F(RotaryRehearsal, ATurnOfCAloneUnderAnUprightToolRunsAtTheDrivesLimitWithTheTipAtRest) {
  const std::string program =
      "G21 G90 M83\nM109 S200\nG28\nG1 X10 Y0 Z0.2 F1200\nG1 X20 E0.33\nG1 C90 F1000\n";
  for (const std::string name : {"five-axis", "trunnion-ac", "trunnion-bc", "head-table"}) {
    const Record record = run(program, name);
    for (const Finding& finding : record.findings) {
      EXPECT_TRUE(std::isfinite(finding.value)) << name << ": " << finding.message;
      EXPECT_NE(finding.gcode_line, 6) << name << ": " << finding.message;
    }
    double turning = 0;
    for (std::size_t k = 1; k < record.trace.size(); ++k) {
      const auto& before = record.trace[k - 1];
      const auto& now = record.trace[k];
      if (now.line != 6) continue;
      EXPECT_LT((now.X_WT_programmed.translation() - Vec3(0.020, 0, 0.0002)).norm(), 1e-7) << name;
      turning += now.time - before.time;
    }
    const machine::MachineDescription machine = machine::load_machine(name);
    const auto& drive = machine.drives[4];
    const double expected = from_deg(90) / drive.velocity_max + drive.velocity_max / drive.acceleration_max;
    EXPECT_NEAR(turning, expected, 0.05) << name;  // the trace's interval, at either end
  }
}

TEST_F(RotaryRehearsal, MachineCoordinatesArePosesOfTheChainsAxes) {
  toolpath::GcodeOptions options;
  options.X_WT_home = machine_.X_WB * machine_.X_BT_home;
  options.rotary = control::rotary_words(machine_);
  ASSERT_TRUE(options.rotary);
  const auto steps =
      toolpath::parse_gcode("G49\nG0 X10 Y-5 Z60 B30 C100\nG43.4\nG49\nX11\n", "p.gcode", options).steps;
  const std::vector<double> axes = {11e-3, -5e-3, 60e-3, from_deg(30), from_deg(100)};
  // Products of exponentials, of which the closed form knows nothing.
  const Pose expected = kinematics::forward(machine_.chain().kinematics.chain, axes);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_LT((steps[1].X_WT.matrix() - expected.matrix()).norm(), 1e-14);
}

/// The printer told as a chain of listed axes, with the letters U V counted the other way.
std::string as_listed_chain(const std::filesystem::path& folder) {
  std::string text = read_file(UNDERSTUDY_SOURCE_DIR "/models/five-axis/machine.yaml");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  const auto geometry = text.find("geometry:");
  text.replace(geometry, text.find("conditioning:") - geometry,
               "geometry:\n  tip_mm: [0, 0, 0]\n  tool_direction: [0, 0, 1]\n"
               "  tool_carried_by: z\n  work_carried_by: c\n\n");
  replace("mechanism: five-axis", "mechanism: chain");
  const auto line = [&](const std::string& name, const std::string& rest) {
    replace("  - name: " + name + "\n", "  - name: " + name + "\n" + rest);
  };
  line("x", "    moves: slides\n    direction: [1, 0, 0]\n    carried_by: frame\n");
  line("y", "    moves: slides\n    direction: [0, 1, 0]\n    carried_by: x\n");
  line("z", "    moves: slides\n    direction: [0, 0, 1]\n    carried_by: y\n");
  line("b",
       "    moves: turns\n    direction: [0, -1, 0]\n    point_mm: [0, 0, -30]\n    carried_by: frame\n");
  line("c", "    moves: turns\n    direction: [0, 0, -1]\n    point_mm: [0, 0, 0]\n    carried_by: b\n");
  replace("{letter: B, axis: b}", "{letter: U, axis: b, sign: -1}");
  replace("{letter: C, axis: c}", "{letter: V, axis: c, unit: revolutions}");
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "machine.yaml") << text;
  return (folder / "machine.yaml").string();
}

TEST_F(RotaryRehearsal, AListedChainRunsByTheWordsOfItsFile) {
  std::string text = "G21 G90 M82\nG43.4\n";
  for (const Line& line : kLines)
    text += fmt::format("{} X{} Y{} Z{} U{} V{}{}\n", line.command, line.tip_mm.x(), line.tip_mm.y(),
                        line.tip_mm.z(), -line.b_deg, line.c_deg / 360, line.rest);
  expect_same_trace(run(with_rotary_words()), run(text, as_listed_chain(folder_ / "listed")));
}

TEST_F(RotaryRehearsal, OtherMachinesHaveNoRotaryWords) {
  for (const std::string name : {"hexapod", "arm"}) {
    EXPECT_FALSE(control::rotary_words(machine::load_machine(name)).has_value()) << name;
    try {
      run("G0 X1 B5\n", name);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("p.gcode:1:7: 'B5': this machine has no rotary axes"));
    }
  }
}

}  // namespace
}  // namespace understudy::rehearsal
