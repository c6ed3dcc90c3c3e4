#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kBead = "G21 G90 M83\nM109 S210\nG28\nG0 X80 Y0 Z0.2\nG1 X100 E0.594 F1200\n";

TEST(Place, SaysWhereDrawsTheMarginAndNamesTheRehearsal) {
  const Folder folder;
  const std::string program = folder.write("bead.gcode", kBead), picture = folder / "map.png",
                    json = folder / "map.json";
  const Outcome seen =
      understudy("place " + program + " --machine corexy --no-turn -o " + picture + " --json " + json);
  EXPECT_EQ(seen.status, 0) << seen.err;
  // 20 mm of 120 in x: 1 - 10 / 60. In y it stands in the middle.
  EXPECT_THAT(seen.out, StartsWith("bead.gcode on corexy: margin 0.833 (axis x) with --place -90,0,0\n"));
  EXPECT_THAT(seen.out,
              HasSubstr("understudy rehearse " + program + " --machine corexy --place -90,0,0 --out bead\n"));
  EXPECT_THAT(read_file(picture), StartsWith("\x89PNG"));
  EXPECT_THAT(read_file(json), AllOf(HasSubstr("\"possible\": true"), HasSubstr("\"margin\": 0.833333"),
                                     HasSubstr("\"columns\": 25")));
}

TEST(Place, NoPlaceIsNoWithTheLimitAndTheLine) {
  const Folder folder;
  const std::string program =
      folder.write("long.gcode", "G21 G90 M83\nG28\nG0 X0 Y0 Z0.2\nG1 X200 E5.94 F1200\n");
  const Outcome seen = understudy("place " + program + " --machine corexy --no-turn");
  EXPECT_EQ(seen.status, 1);
  EXPECT_THAT(seen.out, AllOf(HasSubstr("no place on the table holds every limit"),
                              HasSubstr("it prints 40.000 mm beyond the table's edge"), HasSubstr("(line ")));
}

TEST(Place, BadInputSaysSoBeforeTheWork) {
  const Folder folder;
  const std::string program = folder.write("bead.gcode", kBead);
  for (const std::string& words :
       {"place " + program + " --machine corexy -o map.jpg",
        "place " + program + " -o " + (folder / "none/map.png"),
        "place " + program + " --json " + (folder / "none/map.json"), std::string("place none.gcode"),
        "place " + program + " --grid 1", "rehearse " + program + " --place 1,2",
        "rehearse " + program + " --place there",
        "rehearse " + program + " --machine corexy --home-axes 1 --out " + (folder / "o")}) {
    const Outcome seen = understudy(words);
    EXPECT_EQ(seen.status, 2) << words;
    EXPECT_EQ(seen.out, "") << words;
  }
}

TEST(Place, ARehearsalTakesThePlaceThatIsFound) {
  const Folder folder;
  const std::string program = folder.write("bead.gcode", kBead), out = folder / "out";
  const Outcome run =
      understudy("rehearse " + program +
                 " --machine corexy --place auto --engine quasistatic --no-pictures --out " + out);
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("  placed by --place -63.64,-63.64,0 --turn 45: margin 0.882 (axis "));
  EXPECT_THAT(read_file(out + "/summary.json"), HasSubstr("\"placement\""));
  EXPECT_EQ(understudy("verify " + out).status, 0);
}

}  // namespace
}  // namespace understudy::cli_test
