// Which truths a print's errors come from: the same program on pairs of built worlds, and on those with one
// group of truths exchanged (pick-freeze). Each share is a Sobol index (docs/error-budget.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rehearsal/request/request.h"
#include "sim/as_built/truth_seeds.h"
#include "studies/budget/sobol_indices.h"

namespace understudy::studies {

constexpr int kBudgetSamplesMin = 8;  ///< an interval of fewer says nothing

struct BudgetRequest {
  rehearsal::RehearsalRequest print;  ///< its seeds are not used
  int samples = 64;                   ///< pairs of worlds
  std::uint64_t first_seed = 1;       ///< of them, two each
  int threads = 1;                    ///< the result does not depend on it
  std::string
      journal;  ///< file that keeps the answers until all are there (core/file/run_journal.h); empty: none
};

/// What is rehearsed, before it is.
struct BudgetPlan {
  std::string as_built;                 ///< the set that worlds are drawn from
  std::vector<sim::TruthGroup> groups;  ///< those that the set spreads, and the noise of a camera in use
  int rehearsals = 0;                   ///< samples x (groups + 2)
};

/// Throws InputError for samples out of range, and where nothing varies: one built machine, or a machine
/// file without tolerances.
BudgetPlan plan_budget(const BudgetRequest& request);

/// One figure of a rehearsal.
enum class BudgetQuantity { start_gap_error, path_gap_error, tip_error, in_band_fraction };
constexpr std::size_t kBudgetQuantities = 4;
struct QuantityWords {
  const char* key;   ///< "start_gap_error_um": of files
  const char* unit;  ///< "um", or "1" of a fraction
  const char* what;  ///< in words
};
QuantityWords words(BudgetQuantity quantity);

/// What one rehearsal answered.
struct BudgetAnswer {
  bool stopped = false;  ///< the print ended early, or laid nothing on the part
  /// By BudgetQuantity, in its unit; nothing: this run did not get so far. The fraction of a print that
  /// stopped is 0.
  std::array<std::optional<double>, kBudgetQuantities> values;
};

struct QuantityBudget {
  BudgetQuantity quantity = BudgetQuantity::start_gap_error;
  double mean = 0, sigma = 0;      ///< of the worlds as drawn, two a sample
  int samples = 0;                 ///< that all their rehearsals answered: the others are left out
  std::vector<GroupShare> shares;  ///< by the plan's groups; empty: see `why`
  std::string why;                 ///< why it is not shared out
};

struct ErrorBudget {
  BudgetPlan plan;
  int samples = 0, stopped = 0;  ///< rehearsals that stopped early
  std::uint64_t first_seed = 0;
  std::string machine, machine_sha256, program_sha256, gap_control, engine, command;
  std::vector<QuantityBudget> quantities;
  /// Sample by sample: worlds a and b, then a with each group from b.
  std::vector<std::vector<BudgetAnswer>> answers;
};

/// Throws what rehearse() throws, and InputError as plan_budget() does.
ErrorBudget run_budget(const BudgetRequest& request, const Progress& progress = {});

/// The shares of one quantity. It needs the answers of at least half of the samples.
QuantityBudget share_out(BudgetQuantity quantity, const std::vector<std::vector<BudgetAnswer>>& answers);

}  // namespace understudy::studies
