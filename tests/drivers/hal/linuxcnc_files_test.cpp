#include "drivers/hal/linuxcnc_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::drivers {
namespace {

std::string text_of(const std::vector<HalFile>& files, const std::string& name) {
  const auto file = std::ranges::find(files, name, &HalFile::name);
  return file == files.end() ? "" : file->text;
}

TEST(LinuxcncFiles, HoldTheMachinesJointsAndBeginAtItsHome) {
  const auto files = linuxcnc_files(machine::load_machine("hexapod"));
  // docs/reference.md#machine-g4: 80 mm and 29 mm, pairs at -+ 43 and -+ 17 degrees, base 206 mm above the
  // home tip.
  EXPECT_THAT(text_of(files, "machine.ini"), testing::HasSubstr("HOME = 0 0 -206 "));
  const std::string hal = text_of(files, "machine.hal");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(hal, found, std::regex("setp genhexkins.base.0.x (\\S+)")));
  EXPECT_NEAR(std::stod(found[1]), 80 * std::cos(43 * M_PI / 180), 1e-9);
  ASSERT_TRUE(std::regex_search(hal, found, std::regex("setp genhexkins.platform.0.z (\\S+)")));
  EXPECT_NEAR(std::stod(found[1]), 25, 1e-9);
  EXPECT_THAT(text_of(files, "understudy_moves.ngc"),
              testing::HasSubstr("X#10 Y#11 Z#12 A#13 B#14 C#15 F#16"));
}

TEST(LinuxcncFiles, TurnDistancesIntoStrutLengthsWithinAFifthOfAMicrometre) {
  const std::string hal = text_of(linuxcnc_files(machine::load_machine("hexapod")), "machine.hal");
  std::map<int, double> x, y;  // [mm]
  const std::regex point("setp length.l1.([xy])-val-(\\d\\d) (\\S+)");
  for (std::sregex_iterator i(hal.begin(), hal.end(), point), end; i != end; ++i)
    ((*i)[1] == "x" ? x : y)[std::stoi((*i)[2])] = std::stod((*i)[3]);
  ASSERT_EQ(x.size(), 16U);
  const double home = std::hypot(y.at(0), 15) - x.at(0);  // what the motors count from; 15 mm: deviation_mm
  double worst = 0;
  for (int k = 0; k < 15; ++k)
    for (double share = 0; share <= 1; share += 0.1) {
      const double distance = home + x.at(k) + share * (x.at(k + 1) - x.at(k));
      const double length = y.at(k) + share * (y.at(k + 1) - y.at(k));
      worst = std::max(worst, std::abs(length - std::sqrt(distance * distance - 15 * 15)));
    }
  EXPECT_LE(worst, 1.4e-4);  // a chord: width^2 / 8 * dev^2 / length^3, at the shortest
  EXPECT_LE(y.at(0), 170);
  EXPECT_GE(y.at(15), 240);
}

TEST(LinuxcncFiles, AreOfAHexapodAlone) {
  EXPECT_THROW(linuxcnc_files(machine::load_machine("arm")), InputError);
}

}  // namespace
}  // namespace understudy::drivers
