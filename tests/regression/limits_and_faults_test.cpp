// scenarios/limits/ produces every kind of finding and of fault, so that one which is new, or which is never
// found any more, is noticed.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "regression/metrics.h"
#include "regression/scenario_file.h"
#include "rehearsal/request/fault_words.h"
#include "sim/faults/camera_faults.h"
#include "sim/faults/faults.h"

namespace understudy::regression {
namespace {

// Kinds that no rehearsal reports, and why.
const std::map<std::string, std::string> kNeverFound = {
    {"axis_acceleration", "the planner slows down where an axis would accelerate more than it can"}};

// Kinds that are about the program, the part or a face as a whole.
const std::set<std::string> kWithoutLine = {"left_over", "registration", "placement"};

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = [] {
    std::vector<Scenario> read;
    for (const auto& entry : std::filesystem::directory_iterator(UNDERSTUDY_SOURCE_DIR "/scenarios/limits"))
      if (entry.path().extension() == ".yaml") read.push_back(load_scenario(entry.path()));
    return read;
  }();
  return all;
}

std::vector<std::string> finding_kinds() {
  const std::string before = "findings.", after = ".line";
  std::vector<std::string> kinds;
  for (const std::string& name : metric_names())
    if (name.starts_with(before) && name.ends_with(after))
      kinds.push_back(name.substr(before.size(), name.size() - before.size() - after.size()));
  return kinds;
}

bool expects_at_least_one(const Scenario& scenario, const std::string& metric) {
  return std::ranges::any_of(scenario.expect, [&](const Expectation& e) {
    const auto* number = e.equals ? std::get_if<double>(&*e.equals) : nullptr;
    return e.metric == metric && number != nullptr && *number >= 1;
  });
}

bool is_produced(const std::string& kind) {
  return std::ranges::any_of(scenarios(), [&](const Scenario& scenario) {
    return expects_at_least_one(scenario, "findings." + kind + ".count") &&
           (kWithoutLine.contains(kind) || expects_at_least_one(scenario, "findings." + kind + ".line"));
  });
}

TEST(LimitsAndFaults, EveryKindOfFindingIsProducedWithItsLine) {
  ASSERT_GE(finding_kinds().size(), 20u);
  for (const std::string& kind : finding_kinds())
    EXPECT_NE(is_produced(kind), kNeverFound.contains(kind))
        << kind << ": a scenario in scenarios/limits/ expects its count and its line";
}

TEST(LimitsAndFaults, EveryKindOfFaultIsProduced) {
  ASSERT_GE(rehearsal::machine_fault_words().size(), 6u);
  for (const std::string& word : rehearsal::machine_fault_words())
    EXPECT_TRUE(std::ranges::any_of(scenarios(), [&](const Scenario& scenario) {
      return std::ranges::any_of(scenario.faults,
                                 [&](const auto& f) { return to_string(f.event.kind) == word; });
    })) << word;
  ASSERT_GE(rehearsal::camera_fault_words().size(), 10u);
  for (const std::string& word : rehearsal::camera_fault_words())
    EXPECT_TRUE(std::ranges::any_of(scenarios(), [&](const Scenario& scenario) {
      return std::ranges::any_of(scenario.camera_faults,
                                 [&](const auto& f) { return to_string(f.event.kind) == word; });
    })) << word;
}

TEST(LimitsAndFaults, AFaultIsExpectedToShow) {
  for (const Scenario& scenario : scenarios()) {
    if (scenario.faults.empty() && scenario.camera_faults.empty()) continue;
    EXPECT_TRUE(std::ranges::any_of(scenario.expect,
                                    [](const Expectation& e) {
                                      return e.metric.starts_with("findings.") &&
                                             e.metric.ends_with(".line") && e.equals;
                                    }) ||
                scenario.name == "limits-registration")
        << scenario.name << " expects no line";
  }
}

}  // namespace
}  // namespace understudy::regression
