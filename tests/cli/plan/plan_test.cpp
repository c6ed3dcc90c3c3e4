#include <algorithm>
#include <sstream>
#include <string_view>
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

std::string without_comments(const std::string& gcode) {
  std::string kept;
  for (std::size_t at = 0; at < gcode.size();) {
    const auto end = std::min(gcode.find('\n', at), gcode.size());
    if (gcode[at] != ';') kept += gcode.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return kept;
}

// Word by word: X, Y, Z and E to `tolerance` [mm], all others to the character.
void expect_same_moves(const std::string& made, const std::string& shipped, double tolerance) {
  std::istringstream made_words(made), shipped_words(shipped);
  std::string ours, theirs;
  int words = 0;
  while (shipped_words >> theirs) {
    ASSERT_TRUE(made_words >> ours) << "ends after " << words << " words";
    ++words;
    ASSERT_EQ(ours[0], theirs[0]) << "word " << words;
    if (std::string_view("XYZE").find(ours[0]) == std::string_view::npos)
      ASSERT_EQ(ours, theirs) << "word " << words;
    else
      ASSERT_NEAR(std::stod(ours.substr(1)), std::stod(theirs.substr(1)), tolerance + 1e-9)
          << "word " << words;
  }
  EXPECT_FALSE(made_words >> ours) << ours;
  EXPECT_GT(words, 100);
}

TEST(PlanSurface, MakesTheShippedBottleLineAgain) {
  const Folder folder;
  const Outcome outcome =
      understudy("plan surface bottle --section 0 0 0 0 1 0 --tilt -20 20 -o " + (folder / "line.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(without_comments(read_file(folder / "line.gcode")),
            without_comments(read_file(kSource + "/scenarios/song-bottle.gcode")));
}

TEST(PlanSurface, TakesAnyCurveOnAnyMesh) {
  const Folder folder;
  const auto curve = folder.write("curve.csv", "x_mm,y_mm,z_mm\n-3,-10,31\n0,0,31\n3,10,31\n");
  const Outcome outcome = understudy("plan surface " + kSource + "/models/parts/bottle.stl --curve " + curve +
                                     " -o " + (folder / "line.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(read_file(folder / "line.gcode"), HasSubstr("Y10"));
}

TEST(PlanSurface, NamesTheCurveThatIsNotOnThePart) {
  const Folder folder;
  const auto near = folder.write("near.csv", "x_mm,y_mm,z_mm\n-3,-10,31\n0,0,31\n3,10,31\n");
  const auto far = folder.write("far.csv", "x_mm,y_mm,z_mm\n-3,-10,31\n0,0,310\n3,10,31\n");
  const Outcome outcome = understudy("plan surface bottle --curve " + near + " --curve " + far + " -o " +
                                     (folder / "line.gcode"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("far.csv: point 2 of the curve, (0.000, 0.000, 310.000) mm, is "));
  EXPECT_EQ(folder.entries(), 2);
}

TEST(PlanSurface, RefusesWhatItCannotPlanAndWritesNothing) {
  const Folder folder;
  const std::string out = " -o " + (folder / "line.gcode");
  for (const std::string& words :
       {std::string("plan surface bottle --tilt 20 -20") + out,
        std::string("plan surface bottle --feed -1") + out, std::string("plan surface nothing.stl") + out,
        std::string("plan surface bottle --section 0 500 0 0 1 0") + out,
        std::string("plan surface bottle --tilt -80 80") + out}) {
    const Outcome outcome = understudy(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words << outcome.err;
    EXPECT_EQ(folder.entries(), 0) << words;
  }
}

TEST(PlanSurface, RowsOnTheCoreMakeTheShippedConformalFinishAgain) {
  const Folder folder;
  const Outcome outcome = understudy(
      "plan surface crown_core --tilt -17 17 --rows 28 --pitch 0.42 --layers 3 --step 1 --chord 4 "
      "--clearance 4 -o " +
      (folder / "conformal.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(without_comments(read_file(folder / "conformal.gcode")),
            without_comments(read_file(kSource + "/scenarios/surface-finish/conformal.gcode")));
}

TEST(PlanPlanar, MakesTheShippedStaircaseAgain) {
  const Folder folder;
  const Outcome outcome =
      understudy("plan planar crown --core crown_base --pitch 0.42 -o " + (folder / "planar.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // 17 layers of 0.13 mm from the base at 18.20 mm to the crown's top at 20.41 mm.
  EXPECT_THAT(outcome.out, HasSubstr("17 layers of 0.13 mm"));
  // The outline is simplified to 1 um, and either of two points within it may be kept.
  expect_same_moves(without_comments(read_file(folder / "planar.gcode")),
                    without_comments(read_file(kSource + "/scenarios/surface-finish/planar.gcode")), 1e-3);
}

TEST(PlanSpiral, MakesTheShippedSpiralAgain) {
  const Folder folder;
  const Outcome outcome = understudy("plan spiral -o " + (folder / "spiral.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("a helix of 127.2 mm"));  // 2 hypot(2 pi 10, 10)
  EXPECT_EQ(without_comments(read_file(folder / "spiral.gcode")),
            without_comments(read_file(kSource + "/scenarios/spiral-in-air/spiral.gcode")));
}

/// Han 2024, 4.2: 12 mm round, 46 mm high, overhanging by more than 45 degrees; 51.07 mm along its axis.
TEST(PlanSupportFree, LaysABentCylinderInOnePath) {
  const Folder folder;
  const Outcome outcome =
      understudy("plan support-free bent_cylinder --machine five-axis -o " + (folder / "bent.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex(": 25[56] layers of "));
  EXPECT_THAT(outcome.out, HasSubstr(", 0 travels; the tool leans by up to "));
}

TEST(PlanSurface, WritesTheTurningAxesOfTheMachineOnRequest) {
  const Folder folder;
  const std::string plan = "plan surface crown_core --tilt -17 17 --machine five-axis --rotary-words -o ";
  ASSERT_EQ(understudy(plan + (folder / "a.gcode")).status, 0);
  const std::string program = read_file(folder / "a.gcode");
  EXPECT_THAT(program, ::testing::ContainsRegex("\nG1 X[-0-9.]+ Y[-0-9.]+ Z[-0-9.]+ B[-0-9.]+ C[-0-9.]+ E"));
  const Outcome rehearsed =
      understudy("rehearse " + (folder / "a.gcode") +
                 " --machine five-axis --fixture crown_core --engine quasistatic --no-pictures --out " +
                 (folder / "out"));
  EXPECT_EQ(rehearsed.status, 0) << rehearsed.out << rehearsed.err;
  const Outcome none = understudy("plan surface bottle --rotary-words -o " + (folder / "b.gcode"));
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("hexapod has no rotary words"));
}

TEST(PlanSurface, RefusesATiltThatTheMachineCannotTakeAndSaysWhichItCould) {
  const Folder folder;
  const std::string plan = "plan surface bottle --tilt -60 60 -o " + (folder / "a.gcode");
  const Outcome refused = understudy(plan);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("which hexapod cannot follow: "));
  EXPECT_THAT(refused.err, ::testing::ContainsRegex("it could lean by [0-9.]+ deg there"));
  EXPECT_EQ(understudy(plan + " --ignore-reach").status, 0);
}

TEST(PlanSupportFree, NamesTheTiltThatTheMachineCannotFollow) {
  const Folder folder;
  const std::string plan =
      "plan support-free bent_cylinder --layer 0.3 --layer-range 0.2,0.45 -o " + (folder / "b.gcode");
  // A printer that does not tilt at all, and the hexapod, which tilts by some degrees.
  const Outcome level = understudy(plan + " --machine corexy");
  EXPECT_EQ(level.status, 2);
  EXPECT_THAT(level.err, HasSubstr("the tool leans by 0."));
  EXPECT_THAT(level.err, HasSubstr("deg, which corexy cannot follow: "));
  EXPECT_THAT(level.err, HasSubstr("it could lean by 0.0 deg there"));
  EXPECT_EQ(understudy(plan + " --machine hexapod").status, 2);
  EXPECT_EQ(understudy(plan + " --machine corexy --ignore-reach").status, 0);
}

/// Programs have tips and tool axes; open5x takes X Y Z for its slides unless a program says otherwise.
TEST(Plan, WritesForTheMachineWhatItsControllerReads) {
  const Folder folder;
  ASSERT_EQ(understudy("plan spiral --machine open5x -o " + (folder / "s.gcode")).status, 0);
  EXPECT_THAT(read_file(folder / "s.gcode"), HasSubstr("\nG43.4\n"));
  const Outcome outcome =
      understudy("rehearse " + (folder / "s.gcode") +
                 " --machine open5x --engine quasistatic --no-pictures --out " + (folder / "s"));
  EXPECT_NE(outcome.status, 2) << outcome.err;
}

TEST(PlanWaypoints, SetsALayerOnTheTable) {
  const Folder folder;
  const auto layer = folder.write("layer.txt", "0 5 0 0 1 0\n1 5 0 0 1 0\n2 5 0 0 1 0\n");
  const Outcome outcome = understudy(
      "plan waypoints " + layer + " --machine arm --up y --place 10,20,0.13 -o " + (folder / "layer.gcode"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 layers, 1 strokes, 2.0 mm of bead"));
  EXPECT_THAT(read_file(folder / "layer.gcode"), HasSubstr("G1 X9 Y20 Z0.13 W1 I0 J0 K0"));
}

// A box of 2 `half` mm each way and 30 mm high on z = 0; the first `count` of its 12 triangles.
std::string box_stl(double half, std::size_t count) {
  const std::vector<Vec3> corners = geometry::box_corners(Vec3(-half, -half, 0), Vec3(half, half, 30));
  std::string text = "solid box\n";
  for (std::size_t t = 0; t < count; ++t) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : geometry::box_triangles()[t]) {
      const Vec3& corner = corners[static_cast<std::size_t>(i)];
      text += fmt::format("vertex {} {} {}\n", corner.x(), corner.y(), corner.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

TEST(PlanFinishing, GoesRoundACrossAndWritesTheStockToPrint) {
  const Folder folder;
  const std::string plan =
      "plan finishing cross_90 --machine finishing --from 22 -o " + (folder / "cross.gcode");
  const Outcome outcome = understudy(plan + " --stock " + (folder / "stock.stl"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // Yu 2023, section 4: 4 W - 24 r + 6 pi r = 308.5 mm round, on five layers. A face of 1.5 mm rests on its
  // rim in a hollow of 10 mm: 10 - sqrt(100 - 2.25) = 0.113 mm, a little more where the fit leans over the
  // flat side.
  EXPECT_THAT(outcome.out, HasSubstr("5 layers, 5 outlines, 1542.3 mm of cutting to a depth of 0.7 mm"));
  EXPECT_THAT(outcome.out, HasSubstr("stands up to 0.116 mm off"));
  EXPECT_EQ(read_file(folder / "stock.stl").size(), read_file(kSource + "/models/parts/cross_90.stl").size())
      << "a triangle for each of the part";
}

TEST(PlanFinishing, MakesTheShippedProgramsAgain) {
  const Folder folder;
  for (const std::string part : {"cross_90", "ellipse_75"}) {
    const std::string made = folder / (part + ".gcode");
    ASSERT_EQ(understudy("plan finishing " + part + " --machine finishing --from 24.5 -o " + made).status, 0)
        << part;
    EXPECT_EQ(without_comments(read_file(made)),
              without_comments(read_file(kSource + "/scenarios/finishing/" + part + ".gcode")));
  }
}

TEST(Plan, EveryKindRefusesBadInputInOneLineAndWritesNothing) {
  const Folder folder, inputs;
  const std::string out = " -o " + (folder / "x.gcode");
  const std::string far = inputs.write("far.txt", "1e300 0 5 0 0 1\n1e300 0 6 0 0 1\n");
  for (const auto& [words, message] : std::vector<std::pair<std::string, std::string>>{
           {"plan surface crown_core --rows 0", "--rows"},
           {"plan surface crown_core --rows 2 --pitch -1", "--pitch -1 is outside 0..100"},
           {"plan planar crown --layer 0", "--layer 0 is outside 0..10"},
           {"plan planar crown --layer 0.6", "bead width is 0.48 mm, less than its height of 0.6 mm"},
           {"plan planar crown --machine nothing", "nothing"},
           {"plan waypoints /nonexistent.txt", "/nonexistent.txt"},
           {"plan waypoints " + kSource + "/README.md --up w", "--up 'w' is not x, y, z, -x, -y or -z"},
           {"plan waypoints " + kSource + "/LICENSE", "LICENSE:2:34: 'Apache' is not a finite number"},
           {"plan surface slanted_box --svg-at 0,0,18 --svg-width 80 --svg " + kSource +
                "/scenarios/letters/usc.svg",
            "usc.svg: the drawing reaches beyond the part"},
           {"plan waypoints " + far + " --machine arm", "far.txt:1:1: 1e300 mm is beyond 100000 mm"},
           {"plan lattice box:20x20 ", "'box:20x20' is not a box of three sides in mm"},
           {"plan lattice box:20x20x20 --strut 4", "strut length is 4 mm, outside 5 to 11 mm"},
           {"plan lattice box:20x20x20 --place 1,2", "--place '1,2' is not X,Y,Z in mm"},
           {"plan lattice /nonexistent.json", "/nonexistent.json"},
           {"plan lattice box:20x20x20 --joint-press -1", "--joint-press -1 is outside 0..10"},
           {"plan lattice box:20x20x20 --time-limit 0", "--time-limit 0 is outside 0..86400"},
           {"plan lattice box:20x20x20 --tilt 91", "--tilt 91 is outside 0..90"},
           {"plan lattice box:20x20x20 --directions six", "--directions: six not in {free,five}"},
           {"plan lattice box:20x20x20 --directions five --turn 400", "--turn 400 is outside -360..360"},
           {"plan lattice box:20x20x20 --turn 45", "--turn needs --directions five"},
           {"plan lattice frame.json --directions five",
            "--directions five needs a part, frame.json is a frame"},
           {"plan lattice bottle --directions five", "the part stands on no face"},
           {"plan lattice box:4x20x20 --directions five", "no cube of 5 mm has room on the face"},
           {"plan lattice box:20x20x20 --machine finishing", "its tool does not print"},
           {"plan finishing ellipse_50 --machine finishing --depth-of-cut 0",
            "--depth-of-cut 0 is outside 0..100"},
           {"plan finishing ellipse_50 --machine finishing --depth-of-cut 4",
            "depth of cut is 4 mm, more than the end mill's diameter of 3 mm"},
           {"plan finishing ellipse_50 --machine finishing",
            "into the table: begin with a higher layer (--from)"},
           {"plan finishing ellipse_50 --machine arm", "its tool is no end mill"},
           {"plan finishing " + inputs.write("open.stl", box_stl(20, 11)) + " --machine finishing",
            "the surface is not closed"},
           {"plan finishing /nonexistent.stl --machine finishing", "/nonexistent.stl"},
           {"plan finishing " + inputs.write("large.stl", box_stl(350, 12)) +
                " --machine finishing --from 22",
            "out of reach of finishing: axis"},
           {"plan surface slanted_box --svg-at 0,0,18 --svg " +
                inputs.write("flat.svg", "<svg>\n<path id='u' transform='scale(1,0)' d='M 0 0 h 5'/></svg>"),
            "flat.svg:2: <path id=\"u\">: transform=\"scale(1,0)\": it has no inverse"},
           {"plan surface slanted_box --svg " + kSource + "/scenarios/letters/usc.svg",
            "--svg needs --svg-at X,Y,Z"},
           {"plan surface slanted_box --svg-at 0,0,30 --svg " + kSource + "/scenarios/letters/usc.svg",
            "from the part, more than 5 mm"},
           {"plan surface bottle --machine hexapod+light-guide --feed 20",
            "--feed 20 mm/s: the light cures 0.185 mm deep, less than the layer of 0.250 mm: go slower"},
           {"plan surface bottle --machine hexapod+drill",
            "machine hexapod has no tool 'drill': it has light-guide, cutter"},
           {"plan surface bottle --machine arm+drill", "machine arm has no other tools, so no 'drill'"},
           {"plan spiral --lean 80", "lean is 80 deg, outside 0 to 60 deg"},
           {"plan spiral --temperature 20", "--temperature 20 C is outside 100..450 C"},
           {"plan spiral --pitch 0.3", "pitch is 0.3 mm, less than two strands of 0.45 mm"}}) {
    const Outcome outcome = understudy(words + out);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words << outcome.err;
    EXPECT_EQ(folder.entries(), 0) << words;
  }
  EXPECT_EQ(understudy("plan lattice --help").status, 0);
}

}  // namespace
}  // namespace understudy::cli_test
