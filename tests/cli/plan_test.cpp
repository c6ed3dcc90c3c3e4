#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/output_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kSource = UNDERSTUDY_SOURCE_DIR;

std::string without_comments(const std::string& gcode) {
  std::string kept;
  for (std::size_t at = 0; at < gcode.size();) {
    const auto end = std::min(gcode.find('\n', at), gcode.size());
    if (gcode[at] != ';') kept += gcode.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return kept;
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

}  // namespace
}  // namespace understudy::cli_test
