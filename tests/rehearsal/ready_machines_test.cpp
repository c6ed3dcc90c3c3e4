// Each machine of models/ that prints, on the quasistatic engine: a small cube, and a line along which its
// turning axes turn, are a go.
#include <filesystem>
#include <fstream>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

constexpr double kLayer = 0.2, kWidth = 0.5;  // [mm]
constexpr const char* kStart = "G21 G90 M83\nM109 S210\n";

/// mm of filament in a bead of this length.
double filament(double length_mm) {
  const double area = (kWidth - kLayer) * kLayer + std::numbers::pi / 4 * kLayer * kLayer;
  return length_mm * area / (std::numbers::pi / 4 * 1.75 * 1.75);
}

struct Example {
  const char* machine;
  const char* turned[2];  ///< the words halfway and at the end of the line
  const char* sides[4] = {nullptr, nullptr, nullptr,
                          nullptr};  ///< of a nozzle that always leans: the word of each wall
};

/// Two rings a layer.
std::string cube() {
  std::string text = std::string(kStart) + "G0 Z20\nG0 X-5 Y-5\n";
  for (int layer = 1; layer <= 5; ++layer)
    for (const double half : {5.0, 4.55}) {
      text += fmt::format("G0 X{0} Y{0} Z{1}\nG1 Z{2} F900\n", -half, kLayer * layer + 1, kLayer * layer);
      for (const auto& [x, y] : {std::pair{half, -half}, {half, half}, {-half, half}, {-half, -half}})
        text += fmt::format("G1 X{} Y{} E{:.5f} F900\n", x, y, filament(2 * half));
    }
  return text + "G0 Z30\n";
}

/// Of a nozzle that always leans: four walls, each with the nozzle leaning outwards, that end before the
/// corners, where it would lean over the wall before.
std::string leaning_cube(const Example& example) {
  std::string text = std::string(kStart) + "G0 Z20\nG0 X-5 Y-5\n";
  constexpr double kFrom[4][2] = {{-4, -5}, {5, -4}, {4, 5}, {-5, 4}},
                   kTo[4][2] = {{4, -5}, {5, 4}, {-4, 5}, {-5, -4}};
  for (int layer = 1; layer <= 5; ++layer)
    for (int side = 0; side < 4; ++side)
      text += fmt::format("G0 Z{}\nG0 X{} Y{}{}\nG1 Z{} F900\nG1 X{} Y{} E{:.5f} F900\n", kLayer * layer + 2,
                          kFrom[side][0], kFrom[side][1], example.sides[side], kLayer * layer, kTo[side][0],
                          kTo[side][1], filament(8));
  return text + "G0 Z30\n";
}

std::string line(const Example& example) {
  return std::string(kStart) + "G0 Z20\nG0 X-10 Y0 Z5\nG1 Z0.2 F600\n" +
         fmt::format("G1 X0{} E{:.5f}\nG1 X10{} E{:.5f}\nG0 Z20\n", example.turned[0], filament(10),
                     example.turned[1], filament(10));
}

class ReadyMachines : public testing::TestWithParam<Example> {
 protected:
  Record run(const std::string& text) const {
    const std::string file = (folder_.path() / "p.gcode").string();
    std::ofstream(file) << text;
    RehearsalRequest request;
    request.program = file;
    request.machine = GetParam().machine;
    request.engine = "quasistatic";
    request.keep_scene = false;
    request.dialect.coordinates =
        machine::load_machine(request.machine).dialect.turn_units.empty() ? "" : "tip";
    return rehearse(request);
  }
  static void expect_go(const Record& record) {
    EXPECT_TRUE(record.go);
    for (const Finding& finding : record.findings)
      EXPECT_NE(finding.severity, Severity::error) << finding.message;
    EXPECT_GT(record.trace.size(), 100u);
  }
  TemporaryFolder folder_;
};

TEST_P(ReadyMachines, PrintASmallCube) {
  expect_go(run(GetParam().sides[0] == nullptr ? cube() : leaning_cube(GetParam())));
}
TEST_P(ReadyMachines, PrintALineOnWhichTheyTurn) { expect_go(run(line(GetParam()))); }

INSTANTIATE_TEST_SUITE_P(
    Models, ReadyMachines,
    testing::Values(Example{"trunnion-ac", {" A10 C30", " A-5 C90"}},
                    Example{"trunnion-bc", {" B10 C30", " B-5 C90"}},
                    Example{"head-table", {" B10 C30", " B-5 C90"}},
                    Example{"head-head", {" B10 C30", " B-5 C90"}},
                    Example{"open5x", {" U10 V30", " U-5 V90"}},
                    Example{"tilted-nozzle", {" A30", " A-45"}, {" A0", " A90", " A180", " A270"}},
                    Example{"corexy", {"", ""}}, Example{"delta", {"", ""}},
                    Example{"arm-positioner", {" A10 C30", " A-5 C90"}},
                    Example{"arm-rail", {" I0.087155743 J0 K0.996194698", " I0 J0 K1"}}),
    [](const auto& one) {
      std::string name = one.param.machine;
      std::erase(name, '-');
      return name;
    });

// A printer that cannot turn its tool says so of a program that asks for it.
TEST(ReadyMachinesWithoutTurns, RefuseRotaryWords) {
  const TemporaryFolder folder;
  for (const char* machine : {"delta", "corexy"}) {
    RehearsalRequest request;
    request.program = (folder.path() / "p.gcode").string();
    request.machine = machine;
    request.engine = "quasistatic";
    std::ofstream(request.program) << kStart << "G1 X10 Y0 Z5 B10 F600\n";
    try {
      static_cast<void>(rehearse(request));
      ADD_FAILURE() << machine << " took it";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("'B10': this machine has no rotary axes"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace understudy::rehearsal
