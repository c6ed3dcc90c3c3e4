// An error budget as budget.json, budget.csv, the table of its rehearsals, and lines for a terminal.
#pragma once

#include <string>
#include <vector>

#include "studies/budget/error_budget.h"

namespace understudy::report {

/// What changes the spread of a group on machines built by `as_built`: the key of the machine file, and what
/// is to be done to the machine.
struct Remedy {
  std::string key, procedure;
};
Remedy remedy_of(sim::TruthGroup group, const std::string& as_built);

/// Of an index, to hundredths; never "-0.00".
std::string share_text(double share);

/// Indices into the groups of a budget, the largest total first.
std::vector<std::size_t> by_total(const studies::QuantityBudget& quantity);

/// "64 samples x (10 groups + 2) = 768 rehearsals of machines as built manufactured".
std::string budget_cost(const studies::BudgetPlan& plan, int samples);

std::string budget_json(const studies::ErrorBudget& budget);
std::string budget_csv(const studies::ErrorBudget& budget);       ///< a line for each quantity and group
std::string budget_runs_csv(const studies::ErrorBudget& budget);  ///< a line for each rehearsal
std::string budget_table(const studies::ErrorBudget& budget);     ///< for a terminal

}  // namespace understudy::report
