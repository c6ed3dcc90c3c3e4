#include "calibration/table/header_units.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

TEST(HeaderUnits, ABracketBehindTheNameIsAUnitWhereItIsOne) {
  for (const auto& [header, name, unit] : {std::tuple("X  [mm]", "X", "mm"),
                                           {"A1 (deg)", "A1", "deg"},
                                           {"U(95)  [mm]", "U(95)", "mm"},
                                           {"U(95)", "U(95)", ""},
                                           {"RMS [\xc2\xb5m]", "RMS", "um"},
                                           {"RMS [\xb5m]", "RMS", "um"},
                                           {"q [\xc2\xb0]", "q", "deg"},
                                           {"l (in)", "l", "inch"},
                                           {"[mm]", "", "mm"},
                                           {"T [\xc2\xb0"
                                            "C]",
                                            "T [\xc2\xb0"
                                            "C]",
                                            ""}}) {
    EXPECT_EQ(header_name(header).name, name) << header;
    EXPECT_EQ(header_name(header).unit, unit) << header;
  }
}

TableMap position_map(bool told, double unit) {
  TableMap map;
  map.kind = RowKind::position;
  map.position = NumberColumns{{"X", "Y", "Z"}, unit, told, {"U"}, unit};
  map.joints.columns = {"q"};
  return map;
}

std::string refused(const std::string& header, TableMap map) {
  const DelimitedText text(header + "\n1,2,3,4,5\n", "t.csv", {});
  try {
    settle_units(text, text, map);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(HeaderUnits, SettleWhatTheMapLeavesOut) {
  const DelimitedText text("X [mm],Y [mm],Z [mm],U [um],q [deg]\n1,2,3,4,5\n", "t.csv", {});
  TableMap map = position_map(false, 1);
  settle_units(text, text, map);
  EXPECT_EQ(map.position->unit, kMillimetre);
  EXPECT_EQ(map.position->sigma_unit, kMicrometre);
  EXPECT_TRUE(map.joint_unit_told);
  EXPECT_EQ(map.joints.unit, kDegree);
  EXPECT_FALSE(map.slide_unit_told);
}

TEST(HeaderUnits, ContradictionsAndSilenceAreRefused) {
  EXPECT_THAT(refused("X [mm],Y [mm],Z [mm],U,q", position_map(true, 1)),
              HasSubstr("t.csv: the header says mm of 'X', the map's position.unit says m: mend"));
  EXPECT_THAT(refused("X [mm],Y [m],Z [mm],U,q", position_map(false, 1)),
              HasSubstr("columns 'X [mm]' and 'Y [m]' have different units"));
  EXPECT_THAT(refused("X,Y,Z,U,q", position_map(false, 1)),
              HasSubstr("no header names the unit of position: state position.unit in the map"));
  TableMap map = position_map(true, 1e-3);
  map.joint_unit_told = true;
  map.joints.unit = 1;
  EXPECT_THAT(refused("X,Y,Z,U,q (deg)", map), HasSubstr("the map's joints.unit says rad"));
  EXPECT_EQ(refused("X,Y,Z,U,q", position_map(true, 1e-3)), "accepted");
}

}  // namespace
}  // namespace understudy::calibration
