// Budgets of the bottle's line, where physics says what can matter, and of answers made by hand.
#include "studies/budget/error_budget.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::studies {
namespace {

using sim::TruthGroup;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Half a millimetre of the bottle's line (scenarios/song-bottle.gcode) without its approach, to be fast.
constexpr const char* kLine =
    "G21\nG90\nM82\nG94\nM109 S230\n"
    "G0 X-5.34577 Y0 Z30.187397 W0.984807753 I0 J-0.173648178 K0\n"
    "G1 X-5.112004 Y0 Z30.270181 W0.98615421 I0 J-0.16583086 K0 E0.006035 F300\n"
    "G1 X-4.876968 Y0 Z30.349281 W0.987438993 I0 J-0.158000744 K0 E0.012069\n";

class BottleBudget : public testing::Test {
 protected:
  BottleBudget() {
    write_file(folder_ / "line.gcode", kLine);
    request_.print.program = (folder_ / "line.gcode").string();
    request_.print.fixture = "bottle";
    request_.print.engine = "quasistatic";
    request_.print.as_built = "manufactured";
    request_.print.gap_control = "off";
    request_.samples = kBudgetSamplesMin;
    request_.threads = 2;
  }

  /// The hexapod with tolerances of our own.
  void use_tolerances(const std::string& yaml) {
    std::string machine = read_file(machine::models_folder() / "hexapod/machine.yaml");
    const auto from = machine.find("\ntolerances:"), to = machine.find("\nprocess:", from);
    machine.replace(from, to - from, "\ntolerances:\n" + yaml);
    write_file(folder_ / "machine.yaml", machine);
    request_.print.machine = (folder_ / "machine.yaml").string();
  }
  std::string refusal() {
    try {
      (void)plan_budget(request_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const TemporaryFolder folder_;
  BudgetRequest request_;
};

constexpr const char* kSmallGeometry =
    "  manufactured: {joint_position_mm: 0.02, length_offset_mm: 0.02}\n"
    "  after_calibration: {joint_position_mm: 0.02, length_offset_mm: 0.02}\n";
constexpr const char* kNoGeometry =
    "  manufactured: {joint_position_mm: 0, length_offset_mm: 0}\n"
    "  after_calibration: {joint_position_mm: 0, length_offset_mm: 0}\n";

// Without gap control nothing that is done to the part or the filament moves the tool, and the part's place
// moves the gap.
class ExtendedBottleBudget : public BottleBudget {};

TEST_F(ExtendedBottleBudget, OnlyTheMachinesOwnErrorsMoveItsTip) {
  use_tolerances(std::string(kSmallGeometry) +
                 "  part: {position_mm: 0.02}\n  process: {extruder_lag_permille: 100}\n");
  const ErrorBudget budget = run_budget(request_);
  ASSERT_THAT(budget.plan.groups,
              ElementsAre(TruthGroup::geometry, TruthGroup::part_place, TruthGroup::process));
  EXPECT_EQ(budget.plan.rehearsals, 8 * 5);
  const QuantityBudget& tip = budget.quantities.at(static_cast<std::size_t>(BudgetQuantity::tip_error));
  ASSERT_EQ(tip.shares.size(), 3u) << tip.why;
  EXPECT_EQ(tip.samples, 8);
  EXPECT_EQ(tip.shares[0].first.value, 1);
  EXPECT_EQ(tip.shares[0].total.value, 1);
  for (const std::size_t other : {1u, 2u}) {
    EXPECT_EQ(tip.shares[other].first.value, 0);
    EXPECT_EQ(tip.shares[other].total.value, 0);
  }
  const QuantityBudget& gap = budget.quantities.at(static_cast<std::size_t>(BudgetQuantity::path_gap_error));
  ASSERT_EQ(gap.shares.size(), 3u) << gap.why;
  EXPECT_GT(gap.shares[0].total.value, 0.02);
  EXPECT_GT(gap.shares[1].total.value, 0.02);
}

TEST_F(BottleBudget, OneGroupWithTolerancesIsAllThereIs) {
  use_tolerances(std::string(kNoGeometry) + "  part: {position_mm: 0.02}\n");
  const ErrorBudget budget = run_budget(request_);
  ASSERT_THAT(budget.plan.groups, ElementsAre(TruthGroup::part_place));
  for (const QuantityBudget& quantity : budget.quantities)
    for (const GroupShare& share : quantity.shares) EXPECT_EQ(share.total.value, 1);
  EXPECT_FALSE(budget.quantities.at(0).shares.empty());
  const QuantityBudget& tip = budget.quantities.at(static_cast<std::size_t>(BudgetQuantity::tip_error));
  EXPECT_THAT(tip.shares, IsEmpty());
  EXPECT_THAT(tip.why, HasSubstr("same on all machines"));
}

TEST_F(BottleBudget, WhereTheCameraLooksItsNoiseAndItsMountsAreGroups) {
  request_.print.gap_control = "start";
  EXPECT_THAT(plan_budget(request_).groups, testing::ElementsAreArray(sim::all_truth_groups()));
  EXPECT_EQ(plan_budget(request_).rehearsals, 8 * 14);
  request_.print.as_built = "sampled";
  EXPECT_THAT(plan_budget(request_).groups, ElementsAre(TruthGroup::geometry, TruthGroup::noise));
}

TEST_F(BottleBudget, WhatDoesNotVaryIsRefused) {
  request_.samples = 7;
  EXPECT_THAT(refusal(), HasSubstr("--samples 7 is outside 8.."));
  request_.samples = 8;
  request_.print.as_built = "nominal";
  EXPECT_THAT(refusal(), HasSubstr("one machine"));
  use_tolerances(kNoGeometry);
  request_.print.as_built = "sampled";
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("machine.yaml"),
                                        HasSubstr("no tolerance of what acts here is above 0")));
}

/// A world's answer: a tip error, or none of a print that stopped.
BudgetAnswer answer(std::optional<double> tip) {
  BudgetAnswer one;
  one.stopped = !tip;
  one.values[static_cast<std::size_t>(BudgetQuantity::tip_error)] = tip;
  one.values[static_cast<std::size_t>(BudgetQuantity::in_band_fraction)] = tip ? 1 : 0;
  return one;
}

TEST(ShareOut, ASampleWithoutAnAnswerIsLeftOutAndCounted) {
  std::vector<std::vector<BudgetAnswer>> answers;
  for (int i = 0; i < 8; ++i) answers.push_back({answer(i), answer(i + 3), answer(i + 3)});
  answers[2][2] = answer({});
  const QuantityBudget tip = share_out(BudgetQuantity::tip_error, answers);
  EXPECT_EQ(tip.samples, 7);
  ASSERT_EQ(tip.shares.size(), 1u);
  EXPECT_EQ(tip.shares[0].total.value, 1);
  EXPECT_EQ(share_out(BudgetQuantity::in_band_fraction, answers).samples, 8);
}

TEST(ShareOut, FewerThanHalfOfTheSamplesAreTooFew) {
  std::vector<std::vector<BudgetAnswer>> answers;
  for (int i = 0; i < 8; ++i) answers.push_back({answer(i), answer(i + 3), i < 3 ? answer(i) : answer({})});
  const QuantityBudget tip = share_out(BudgetQuantity::tip_error, answers);
  EXPECT_THAT(tip.shares, IsEmpty());
  EXPECT_THAT(tip.why, HasSubstr("3 of 8"));
}

}  // namespace
}  // namespace understudy::studies
