#include "report/page/over_time.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "report/page/unpack.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

using nlohmann::ordered_json;

std::vector<double> values(const ordered_json& column) {
  return unpack_values(column["data"].get<std::string>(), column["unit"].get<double>());
}

rehearsal::Record record_of(int stretches) {
  rehearsal::Record record;
  record.axes = {{"l1_mm", {}, {}}, {"b_deg", {}, {}}};
  for (int i = 0; i < stretches; ++i) {
    rehearsal::CurveStretch stretch;
    stretch.begin = i, stretch.end = i + 0.9;
    stretch.force[0].add(-1.5 * i);
    stretch.force[0].add(2.25);
    if (i != 2) stretch.nozzle_temperature.add(kCelsiusZero + 210.5);
    if (i == 1) stretch.nozzle_clearance.add(0.1234e-3);
    record.curves.stretches.push_back(stretch);
  }
  record.curves.flips = {{0.5, 0}, {2.125, 3}};
  record.curves.flip_count = 7;
  return record;
}

TEST(OverTime, ColumnsHoldTheCurvesInTheUnitsOfFiles) {
  const ordered_json object = over_time(record_of(4));
  EXPECT_EQ(values(object["begin_s"]), (std::vector<double>{0, 1, 2, 3}));
  EXPECT_NEAR(values(object["end_s"])[3], 3.9, 1e-9);
  ASSERT_EQ(object["drives"].size(), 2u);
  EXPECT_EQ(object["drives"][0]["axis"], "l1_mm");
  EXPECT_EQ(object["drives"][0]["unit"], "N");
  EXPECT_EQ(object["drives"][1]["unit"], "N m");
  EXPECT_NEAR(values(object["drives"][0]["low"])[3], -4.5, 1e-9);
  EXPECT_NEAR(values(object["drives"][0]["high"])[3], 2.25, 1e-9);
  EXPECT_TRUE(std::isnan(values(object["drives"][1]["low"])[0]));  // of an axis that no force was told of
  const auto nozzle = values(object["nozzle_c"]["low"]);
  EXPECT_NEAR(nozzle[0], 210.5, 1e-4);
  EXPECT_TRUE(std::isnan(nozzle[2]));
  EXPECT_NEAR(values(object["nozzle_clearance_mm"])[1], 0.123, 1e-9);
  EXPECT_EQ(object["flips"]["count"], 7);
  EXPECT_NEAR(values(object["flips"]["time_s"])[1], 2.125, 1e-9);
  EXPECT_EQ(unpack_integers(object["flips"]["axis"].get<std::string>()), (std::vector<std::int64_t>{0, 3}));
}

TEST(OverTime, WhatARecordLacksHasNoKey) {
  EXPECT_TRUE(over_time({}).is_null());
  rehearsal::Record record = record_of(3);
  for (auto& stretch : record.curves.stretches) {
    stretch.force = {};
    stretch.nozzle_clearance = stretch.nozzle_temperature = {};
  }
  const ordered_json object = over_time(record);
  for (const char* key :
       {"drives", "flips", "nozzle_c", "interface_c", "glass_transition_c", "nozzle_clearance_mm"})
    EXPECT_FALSE(object.contains(key)) << key;
}

}  // namespace
}  // namespace understudy::report
