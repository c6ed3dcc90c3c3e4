#include "rehearsal/figures.h"

#include <algorithm>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

std::vector<std::string> sections_of(const Record& record) {
  std::vector<std::string> sections;
  for (const Figure& figure : figures(record))
    if (sections.empty() || sections.back() != figure.section) sections.push_back(figure.section);
  return sections;
}

// GCC 12 takes members of an empty std::optional on the stack for uninitialised (its PR 80635), not on the
// heap.
std::unique_ptr<Record> empty_record() { return std::make_unique<Record>(); }

double value_of(const Record& record, const std::string& name) {
  for (const Figure& figure : figures(record))
    if (figure.section + "." + figure.name == name) return std::get<double>(figure.value);
  return -1;
}

// A quarter turn at a lean of 30 degrees in 90 steps: each turns the axis by sin 30 degrees of a degree,
// along the small circle's chord. What is not extruded does not count.
TEST(Figures, TellHowTheToolLeansAndTurnsWhileItExtrudes) {
  const auto record = empty_record();
  record->print.emplace();
  const auto add = [&](double lean, double azimuth, bool extruding) {
    TracePoint point;
    point.extruding = extruding;
    point.X_WT_programmed.linear() =
        (Eigen::AngleAxisd(azimuth, Vec3::UnitZ()) * Eigen::AngleAxisd(lean, Vec3::UnitY()))
            .toRotationMatrix();
    record->trace.push_back(point);
  };
  add(80 * kDegree, 0, false);
  for (int i = 0; i <= 90; ++i) add(30 * kDegree, i * kDegree, true);
  add(0, 0, false);
  EXPECT_NEAR(value_of(*record, "print.tilt_max_deg"), 30, 1e-9);
  EXPECT_NEAR(value_of(*record, "print.turned_deg"), 45, 1e-3);
}

TEST(Figures, ComeSectionBySectionInTheContractsOrder) {
  const auto empty = empty_record();
  Record& record = *empty;
  record.print.emplace();
  record.accuracy.emplace();
  record.calibration = CalibrationFigures{};
  record.gap.emplace();
  record.sag.emplace();
  record.collision.emplace();
  record.surface = SurfaceFigures{1.0, {}, {}};
  record.engine.emplace();
  EXPECT_THAT(sections_of(record), testing::ElementsAre("print", "accuracy", "calibration", "gap", "sag",
                                                        "collision", "surface", "engine", "provenance"));
  std::set<std::string> names;
  for (const Figure& figure : figures(record)) names.insert(figure.section + "." + figure.name);
  EXPECT_EQ(names.size(), figures(record).size());
}

TEST(Figures, WhatIsAbsentIsLeftOut) {
  const auto empty = empty_record();
  Record& record = *empty;
  EXPECT_THAT(sections_of(record), testing::ElementsAre("provenance"));
  record.gap.emplace();
  const auto names = figures(record);
  EXPECT_TRUE(std::none_of(names.begin(), names.end(), [](const Figure& f) {
    return f.name == "open_loop_start_mm" || f.name == "faults";
  }));
}

// A program that moves nothing has no clearance; infinity is no figure.
TEST(Figures, AClearanceThatNobodyLookedAtIsLeftOut) {
  const auto empty = empty_record();
  Record& record = *empty;
  record.collision.emplace();
  for (const Figure& figure : figures(record))
    EXPECT_THAT(figure.name, testing::Not(testing::HasSubstr("clearance")));
  record.collision->nozzle_clearance_mm = -0.07;
  const auto all = figures(record);
  const auto nozzle =
      std::find_if(all.begin(), all.end(), [](const Figure& f) { return f.name == "nozzle_clearance_mm"; });
  ASSERT_NE(nozzle, all.end());
  EXPECT_EQ(std::get<double>(nozzle->value), -0.07);
}

TEST(Figures, LibrariesStandByTheirNames) {
  const auto empty = empty_record();
  Record& record = *empty;
  record.provenance.libraries = {{"FCL", "0.7.0"}, {"MuJoCo", "2.2.2"}};
  const Figure libraries = figures(record).back();
  EXPECT_EQ(libraries.section + "." + libraries.name, "provenance.libraries");
  EXPECT_EQ(std::get<LibraryVersions>(libraries.value), record.provenance.libraries);
}

TEST(Figures, CountsKeepEveryDigit) {
  const auto empty = empty_record();
  Record& record = *empty;
  record.provenance.seed = 18446744073709551615u;
  for (const Figure& figure : figures(record))
    if (figure.name == "seed") {
      EXPECT_EQ(std::get<std::uint64_t>(figure.value), 18446744073709551615u);
    }
}

}  // namespace
}  // namespace understudy::rehearsal
