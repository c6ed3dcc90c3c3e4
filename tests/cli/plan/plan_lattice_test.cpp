// `understudy plan lattice`, and what the rehearsal says of what it plans.
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "geometry/box_mesh.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

TEST(PlanLattice, FillsABoxWithThePapersCubes) {
  const Folder folder;
  const Outcome outcome = understudy("plan lattice box:20x20x15 --strut 5 -o " + (folder / "lattice.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // 4 x 4 x 3 cubes: 80 + 80 struts along x and y, 75 upright, 5 mm each.
  EXPECT_THAT(outcome.out, HasSubstr("235 struts, 1175.0 mm, 0 with the tool tilted"));
  const std::string gcode = read_file(folder / "lattice.gcode");
  EXPECT_THAT(gcode, HasSubstr("F60\n"));          // Ishak 2018: 1 mm/s
  EXPECT_THAT(gcode, HasSubstr("\nM106 S255\n"));  // forced air
  EXPECT_THAT(gcode, HasSubstr("\nG4 P3000\n"));
}

TEST(PlanLattice, PlansAFrameFromAFileAndWarnsOfItsLengths) {
  const Folder folder;
  const auto frame = folder.write(
      "frame.json",
      R"({"unit": "centimeter", "node_list": [{"point": {"X": 0, "Y": 0, "Z": 0}, "is_grounded": 1},
          {"point": {"X": 0, "Y": 0, "Z": 2}, "is_grounded": 0}, {"point": {"X": 1, "Y": 0, "Z": 2}, "is_grounded": 0}],
          "element_list": [{"end_node_ids": [0, 1]}, {"end_node_ids": [1, 2]}]})");
  const Outcome outcome = understudy("plan lattice " + frame + " -o " + (folder / "frame.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: 1 of 2 struts are outside 5..11 mm (Ishak 2018), the longest 20.0 mm"));
  EXPECT_THAT(outcome.out, HasSubstr("2 struts, 30.0 mm"));
}

// Posts, a ring with a diagonal, posts on it, another ring and a diagonal through space: at its joints five
// struts meet, upright, level and leaning. The arm in the twin errs by some hundredths of a millimetre.
TEST(PlanLattice, AFrameThatIsPlannedIsPrintedWithoutRunningIntoItsJoints) {
  const Folder folder;
  std::string nodes, struts;
  for (const int z : {0, 5, 15})
    for (const auto& [x, y] : {std::pair(-5, -5), std::pair(5, -5), std::pair(5, 5), std::pair(-5, 5)})
      nodes += fmt::format(R"({}{{"point": {{"X": {}, "Y": {}, "Z": {}}}, "is_grounded": {}}})",
                           nodes.empty() ? "" : ", ", x, y, z, z == 0 ? 1 : 0);
  std::vector<std::pair<int, int>> ends = {{4, 5}, {5, 6},  {6, 7},   {7, 4},  {4, 6},
                                           {8, 9}, {9, 10}, {10, 11}, {11, 8}, {11, 5}};
  for (int post = 0; post < 8; ++post) ends.emplace_back(post, post + 4);
  for (const auto& [from, to] : ends)
    struts += fmt::format(R"({}{{"end_node_ids": [{}, {}]}})", struts.empty() ? "" : ", ", from, to);
  const auto frame = folder.write("frame.json", R"({"unit": "millimeter", "node_list": [)" + nodes +
                                                    R"(], "element_list": [)" + struts + "]}");
  const std::string program = folder / "frame.gcode";
  ASSERT_EQ(understudy("plan lattice " + frame + " --place 0,0,0.05 -o " + program).status, 0);
  const Outcome rehearsed = understudy(
      "rehearse " + program + " --machine arm --engine quasistatic --no-pictures --out " + (folder / "out"));
  EXPECT_EQ(rehearsed.status, 0) << rehearsed.out << rehearsed.err;
}

TEST(PlanLattice, FramesOfOthersAreGoOrRefusedWithTheStrutAndTheReason) {
  const std::string shared = kSource + "/../shared/data/lattices/";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "the folder shared/data is not beside the repository";
  const Folder folder;
  const std::string program = folder / "frame.gcode";
  ASSERT_EQ(understudy("plan lattice " + shared + "four-frame.json --place 0,0,0.05 -o " + program).status,
            0);
  EXPECT_EQ(understudy("rehearse " + program + " --machine arm --engine quasistatic --no-pictures --out " +
                       (folder / "out"))
                .status,
            0);
  const Outcome refused = understudy("plan lattice " + shared +
                                     "topopt-100_S1_03-14-2019_w_layer.json --place 0,0,0.05 -o " + program);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, ::testing::ContainsRegex("strut [0-9]+ from .* to .*: no tool axis within"));
}

TEST(PlanLattice, RefusesAStrutThatTheMachineCannotReachAndSaysWhy) {
  const Folder folder;
  // The arm stands 450 mm from the table's middle and reaches 677 mm (docs/reference.md).
  const auto frame = folder.write(
      "far.json",
      R"({"unit": "millimeter", "node_list": [{"point": {"X": 0, "Y": 0, "Z": 0}, "is_grounded": 1},
          {"point": {"X": 8, "Y": 0, "Z": 8}, "is_grounded": 0}], "element_list": [{"end_node_ids": [0, 1]}]})");
  const std::string output = folder / "far.gcode";
  const Outcome far = understudy("plan lattice " + frame + " --place 400,0,0 -o " + output);
  EXPECT_EQ(far.status, 2);
  EXPECT_THAT(far.err, HasSubstr("far.json: strut 0 from "));
  EXPECT_THAT(far.err, HasSubstr("no tool axis within 90 deg of vertical can print it: "));
  EXPECT_EQ(understudy("plan lattice " + frame + " --place 400,0,0 --ignore-reach -o " + output).status, 0);
  EXPECT_EQ(understudy("plan lattice " + frame + " -o " + output).status, 0);
}

TEST(PlanLattice, EndsItsSearchInTime) {
  const Folder folder;
  const Outcome outcome =
      understudy("plan lattice box:60x60x60 --time-limit 1e-6 -o " + (folder / "lattice.gcode"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--time-limit"));
  EXPECT_EQ(folder.entries(), 0);
}

// Ishak 2018: the base, then what protrudes in Y-, Y+, X- and X+; 4 x 16 struts on a column of 68.
TEST(PlanLattice, PlansAPartInFiveDirections) {
  const Folder folder;
  const std::string plan = "plan lattice column_with_arms --directions five -o " + (folder / "five.gcode");
  const Outcome outcome = understudy(plan + " --turn 45");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("132 struts, 660.0 mm; the cubes take 100 % of the part"));
  EXPECT_THAT(outcome.out,
              HasSubstr("  Z+: 68 struts\n  Y-: 16 struts\n  Y+: 16 struts\n  X-: 16 struts\n  X+: 16"));
  const std::string gcode = read_file(folder / "five.gcode");
  EXPECT_THAT(gcode,
              HasSubstr("W0.707106781 I0.5 J0.5 K0"));  // Y- turned by 45 degrees: the tool on its side
  EXPECT_THAT(gcode, HasSubstr(" F60\n"));
  // Without the turn the arm would have to fold up to come from its own side.
  const Outcome folded = understudy(plan);
  EXPECT_EQ(folded.status, 2);
  EXPECT_THAT(folded.err, HasSubstr("segment X-, strut from (-2.500, 2.500, 40.240) mm"));
  EXPECT_THAT(folded.err, HasSubstr("above 70.0 deg; --turn and --place may help"));
}

// The nozzle of the scenario's arm has the shape that Ishak 2018 implies: 5 to 11 mm. The slender one of
// `arm` leaves room for shorter struts.
TEST(PlanLattice, TheNozzleLimitsTheStruts) {
  const Folder folder;
  const std::string plan = "plan lattice box:24x24x12 --directions five -o " + (folder / "box.gcode");
  const std::string papers = " --machine " + kSource + "/scenarios/ishak-lattice/arm.yaml";
  for (const char* strut : {"5", "11"})
    EXPECT_EQ(understudy(plan + papers + " --strut " + strut).status, 0) << strut;
  for (const char* strut : {"4", "12"}) {
    const Outcome outcome = understudy(plan + papers + " --strut " + strut);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(std::string("a strut of ") + strut + " mm is outside 4.97..11.40"));
  }
  EXPECT_EQ(understudy(plan + " --strut 4").status, 0);
  EXPECT_EQ(understudy(plan + " --strut 12").status, 2);
}

TEST(PlanLattice, TheScenariosArmIsThatOfTheModelsButForItsNozzle) {
  const auto but_for_the_nozzle = [](const std::string& file) {
    const std::string text = read_file(kSource + file);
    std::string rest;
    std::istringstream lines(text.substr(text.find("\ngeometry:")));
    for (std::string line; std::getline(lines, line);)
      if (line.find("{name: nozzle") == std::string::npos) rest += line + '\n';
    return rest;
  };
  EXPECT_EQ(but_for_the_nozzle("/scenarios/ishak-lattice/arm.yaml"),
            but_for_the_nozzle("/models/arm/machine.yaml"));
}

// 12 mm struts, planned for a tool whose nozzle is 20 mm longer, printed with the arm's: its cooling
// duct, 11.5 mm above the tip, meets a strut that stands already.
TEST(PlanLattice, StrutsThatAreTooLongAreFoundByTheRehearsal) {
  const Folder folder;
  std::string machine = read_file(kSource + "/models/arm/machine.yaml");
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"bottom_centre_mm: [0, 0, 12]", "bottom_centre_mm: [0, 0, 32]"},
           {"from_mm: [13, 0, 14], to_mm: [18, 0, 22]", "from_mm: [13, 0, 34], to_mm: [18, 0, 42]"},
           {"bottom_centre_mm: [0, 0, 24]", "bottom_centre_mm: [0, 0, 44]"}}) {
    const std::size_t place = machine.find(from);
    ASSERT_NE(place, std::string::npos) << from;
    machine.replace(place, from.size(), to);
  }
  const std::string program = folder / "long.gcode";
  ASSERT_EQ(
      understudy(
          "plan lattice box:24x12x12 --strut 12 --directions five --dwell 0 --diameter 0.475 --machine " +
          folder.write("long.yaml", machine) + " -o " + program)
          .status,
      0);
  const Outcome rehearsed = understudy(
      "rehearse " + program + " --machine arm --as-built nominal --engine quasistatic --no-pictures --out " +
      (folder / "out"));
  EXPECT_EQ(rehearsed.status, 1);
  EXPECT_THAT(rehearsed.out, HasSubstr("cooling duct touches bead of line"));
}

}  // namespace
}  // namespace understudy::cli_test
