// Drawings of an error budget's page, as SVG text.
#pragma once

#include <string>

#include "studies/budget/error_budget.h"

namespace understudy::report {

/// Both indices of each group as bars with their intervals, the largest total first; the quantity must have
/// shares.
std::string error_budget_chart(const studies::QuantityBudget& quantity, const studies::BudgetPlan& plan);

}  // namespace understudy::report
