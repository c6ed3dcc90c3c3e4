#include "rehearsal/figures.h"

#include <algorithm>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
