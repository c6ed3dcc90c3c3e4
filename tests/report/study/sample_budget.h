// A small error budget, made by hand.
#pragma once

#include "studies/budget/error_budget.h"

namespace understudy::report {

inline studies::ErrorBudget sample_budget() {
  using sim::TruthGroup;
  using studies::BudgetQuantity;
  studies::ErrorBudget budget;
  budget.plan = {"manufactured", {TruthGroup::geometry, TruthGroup::mounting, TruthGroup::noise}, 40};
  budget.samples = 8;
  budget.stopped = 2;
  budget.first_seed = 1;
  budget.machine = "hexapod <1>";
  budget.gap_control = "start";
  budget.engine = "quasistatic";
  const studies::GroupShare geometry{{0.1, -0.05, 0.2}, {0.2, 0.1, 0.3}},
      mounting{{0.7, 0.5, 0.9}, {0.8, 0.6, 0.95}}, noise{{0, -0.01, 0.01}, {0.01, 0, 0.02}};
  studies::QuantityBudget start, tip;
  start.mean = 3;
  start.sigma = 20;
  start.samples = 7;
  start.shares = {geometry, mounting, noise};
  tip.quantity = BudgetQuantity::tip_error;
  tip.samples = 8;
  tip.why = "it is the same on all machines";
  budget.quantities = {start, tip};
  std::vector<studies::BudgetAnswer> worlds(5);
  worlds[0].values[0] = 1.5;
  worlds[3].stopped = true;
  budget.answers.push_back(worlds);
  return budget;
}

}  // namespace understudy::report
