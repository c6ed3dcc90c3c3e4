#include "regression/metrics.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace understudy::regression {
namespace {

using rehearsal::Record;
using rehearsal::Severity;

/// A run in which every section of the summary was looked at but sag.
Record printed() {
  Record record;
  record.go = true;
  record.print.emplace().moves = 84;
  record.accuracy.emplace();
  record.gap.emplace().start_mm = 0.1312345;
  record.gap->open_loop_start_mm = 0.4;
  record.collision.emplace();
  record.surface = rehearsal::SurfaceFigures{1.0, 2.0, 3.0};
  record.engine.emplace().name = "mujoco";
  return record;
}

Record refused_by_the_constraint_check() {
  Record record;
  record.findings = {
      {"strut_length", Severity::error, 1187, 41.2, 241.7, 240.0, "mm", "strut 3 is too long"}};
  return record;
}

double number(const Metrics& metrics, const std::string& name) { return std::get<double>(metrics.at(name)); }

TEST(Metrics, AreTheFiguresOfARecordUnderDottedNames) {
  const Metrics metrics = metrics_of(printed());
  EXPECT_EQ(number(metrics, "gap.start_mm"), 0.131235);  // six digits of 0.1312345
  EXPECT_EQ(number(metrics, "print.moves"), 84);
  EXPECT_EQ(std::get<std::string>(metrics.at("engine.name")), "mujoco");
  EXPECT_EQ(std::get<std::string>(metrics.at("verdict")), "go");
  EXPECT_EQ(std::get<std::string>(metrics.at("grade")), "go");
  EXPECT_EQ(number(metrics, "exit_status"), 0);
}

TEST(Metrics, CountsFindingsByKindAndSeverity) {
  Record record = printed();
  record.go = false;
  for (int i = 0; i < 27; ++i)
    record.findings.push_back({i % 3 ? "gap" : "adhesion", Severity::error, i, 0, 0, 0, "mm", ""});
  for (int i = 0; i < 3; ++i)
    record.findings.push_back({"axis_velocity", Severity::warning, i, 0, 0, 0, "mm/s", ""});
  const Metrics metrics = metrics_of(record);
  EXPECT_EQ(number(metrics, "findings.count"), 30);
  EXPECT_EQ(number(metrics, "findings.error.count"), 27);
  EXPECT_EQ(number(metrics, "findings.warning.count"), 3);
  EXPECT_EQ(number(metrics, "findings.adhesion.count"), 9);
  EXPECT_EQ(number(metrics, "findings.gap.count"), 18);
  EXPECT_EQ(number(metrics, "findings.collision.count"), 0);
  EXPECT_EQ(number(metrics, "exit_status"), 1);
}

TEST(Metrics, TellTheFirstLineOfEachKindThatNamesOne) {
  Record record = printed();
  for (const int line : {0, 912, 14, 27})
    record.findings.push_back({"gap", Severity::error, line, 0, 0, 0, "mm", ""});
  record.findings.push_back({"left_over", Severity::error, 0, 0, 0, 0, "mm", ""});
  const Metrics metrics = metrics_of(record);
  EXPECT_EQ(number(metrics, "findings.gap.line"), 14);
  EXPECT_FALSE(metrics.contains("findings.left_over.line")) << "it is about no line";
  EXPECT_FALSE(metrics.contains("findings.collision.line")) << "there is none";
  EXPECT_EQ(number(metrics, "findings.gap.count"), 4) << "the one without a line counts";
}

// Zero collisions is a finding of the collision check; without the check there is no such figure.
TEST(Metrics, WhatWasNotLookedForHasNoCount) {
  const Metrics metrics = metrics_of(refused_by_the_constraint_check());
  EXPECT_EQ(number(metrics, "findings.strut_length.count"), 1);
  EXPECT_EQ(number(metrics, "findings.axis_velocity.count"), 0);
  for (const char* kind : {"collision", "near_collision", "gap", "adhesion", "sag", "flow"})
    EXPECT_FALSE(metrics.contains(std::string("findings.") + kind + ".count")) << kind;
}

TEST(Metrics, EveryFigureOfARecordMayBeExpected) {
  const std::vector<std::string>& names = metric_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  Record record = printed();
  record.findings = refused_by_the_constraint_check().findings;
  for (const auto& [name, value] : metrics_of(record)) {
    if (name == "provenance.seed" || name == "provenance.version" || name == "provenance.command") continue;
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
    EXPECT_EQ(metric_is_text(name), std::holds_alternative<std::string>(value)) << name;
  }
}

TEST(Metrics, NamesSayTheirUnit) {
  EXPECT_EQ(metric_unit("gap.start_mm"), "mm");
  EXPECT_EQ(metric_unit("accuracy.tip_max_um"), "um");
  EXPECT_EQ(metric_unit("accuracy.orientation_max_mrad"), "mrad");
  EXPECT_EQ(metric_unit("accuracy.orientation_tolerance_deg"), "deg");
  EXPECT_EQ(metric_unit("removal.volume_mm3"), "mm3");
  EXPECT_EQ(metric_unit("print.duration_s"), "s");
  EXPECT_EQ(metric_unit("gap.in_band_fraction"), "1");
  EXPECT_EQ(metric_unit("findings.count"), "1");
  EXPECT_EQ(metric_unit("verdict"), "");
}

TEST(Metrics, ARunWithoutASummaryHasItsExitStatusOnly) {
  EXPECT_EQ(failed_run(3), (Metrics{{"exit_status", 3.0}}));
}

}  // namespace
}  // namespace understudy::regression
