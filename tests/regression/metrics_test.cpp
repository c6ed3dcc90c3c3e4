#include "regression/metrics.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "report/report.h"
#include "tests/report/sample_record.h"

namespace understudy::rehearsal {
namespace {

double number(const Metrics& metrics, const std::string& name) { return std::get<double>(metrics.at(name)); }

TEST(Metrics, FlattensSectionsIntoDottedNames) {
  const Metrics metrics = flatten(summary_json(sample_go()));
  EXPECT_EQ(number(metrics, "gap.start_mm"), 0.131235);  // six digits of 0.1312345
  EXPECT_EQ(number(metrics, "print.moves"), 84);
  EXPECT_EQ(std::get<std::string>(metrics.at("engine.name")), "mujoco");
  EXPECT_EQ(std::get<std::string>(metrics.at("verdict")), "go");
  EXPECT_EQ(number(metrics, "exit_status"), 0);
}

TEST(Metrics, CountsFindingsByKindAndSeverity) {
  const Metrics metrics = flatten(summary_json(sample_no_go()));
  EXPECT_EQ(number(metrics, "findings.count"), 30);
  EXPECT_EQ(number(metrics, "findings.error.count"), 27);
  EXPECT_EQ(number(metrics, "findings.warning.count"), 3);
  EXPECT_EQ(number(metrics, "findings.adhesion.count"), 9);
  EXPECT_EQ(number(metrics, "findings.gap.count"), 18);
  EXPECT_EQ(number(metrics, "findings.collision.count"), 0);
  EXPECT_EQ(number(metrics, "exit_status"), 1);
}

// Zero collisions is a finding of the collision check; without the check there is no such figure.
TEST(Metrics, WhatWasNotLookedForHasNoCount) {
  const Metrics metrics = flatten(summary_json(sample_stopped_by_constraints()));
  EXPECT_EQ(number(metrics, "findings.strut_length.count"), 1);
  EXPECT_EQ(number(metrics, "findings.axis_velocity.count"), 0);
  for (const char* kind : {"collision", "near_collision", "gap", "adhesion", "sag", "flow"})
    EXPECT_FALSE(metrics.contains(std::string("findings.") + kind + ".count")) << kind;
}

TEST(Metrics, EveryNumberOfASummaryMayBeExpected) {
  const std::vector<std::string>& names = metric_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const auto& [name, value] : flatten(summary_json(sample_go()))) {
    if (name == "provenance.seed" || name == "provenance.version" || name == "provenance.command") continue;
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
    EXPECT_EQ(metric_is_text(name), std::holds_alternative<std::string>(value)) << name;
  }
}

TEST(Metrics, NamesSayTheirUnit) {
  EXPECT_EQ(metric_unit("gap.start_mm"), "mm");
  EXPECT_EQ(metric_unit("accuracy.tip_max_um"), "um");
  EXPECT_EQ(metric_unit("accuracy.orientation_max_mrad"), "mrad");
  EXPECT_EQ(metric_unit("print.duration_s"), "s");
  EXPECT_EQ(metric_unit("gap.in_band_fraction"), "1");
  EXPECT_EQ(metric_unit("findings.count"), "1");
  EXPECT_EQ(metric_unit("verdict"), "");
}

TEST(Metrics, ARunWithoutASummaryHasItsExitStatusOnly) {
  EXPECT_EQ(failed_run(3), (Metrics{{"exit_status", 3.0}}));
}

TEST(Metrics, TextThatIsNoSummaryIsOurOwnMistake) {
  EXPECT_THROW(flatten("{}"), std::logic_error);
  EXPECT_THROW(flatten("not json"), std::logic_error);
}

}  // namespace
}  // namespace understudy::rehearsal
