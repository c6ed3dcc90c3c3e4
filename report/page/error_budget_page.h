// The page of an error budget: a chart and a table for each quantity.
#pragma once

#include <string>

#include "studies/budget/error_budget.h"

namespace understudy::report {

std::string error_budget_html(const studies::ErrorBudget& budget);

}  // namespace understudy::report
