#include "calibration/rows/row_outliers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/rows/surroundings_start.h"
#include "core/distributions.h"

namespace understudy::calibration {
namespace {

constexpr double kSharper = 0.5;  // of the scale, from round to round
// Below the limit: many rows that are off alike draw the fit and widen the noise until none is beyond it.
constexpr double kSharpest = 0.15;
constexpr int kWeightRounds = 60;   // of which a row off by 1000 limits takes 10
constexpr int kReturnRounds = 10;   // in which rows come back
constexpr int kSettlingRounds = 4;  // at the sharpest scale
constexpr int kMostEquations = 6;   // of one row, a pose

/// Largest of the rows' distances, each by its own limit; 1 is the limit.
double farthest(const RowProblem& problem, const RowFit& fit) {
  double most = 0;
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    most = std::max(most, fit.apart[j] / spoiled_from(problem.rows[j].kind));
  return most;
}

/// Geman and McClure's: 1 of a row that fits, 1/4 at the scale, towards 0 beyond.
RowWeights softened(const RowProblem& problem, const RowFit& fit, double scale) {
  RowWeights weights;
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    weights.push_back(std::pow(scale / (scale + fit.apart[j] / spoiled_from(problem.rows[j].kind)), 2));
  return weights;
}

/// 0 of the rows beyond their limit; empty where none is.
RowWeights sharp(const RowProblem& problem, const RowFit& fit) {
  RowWeights weights;
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    weights.push_back(fit.apart[j] > spoiled_from(problem.rows[j].kind) ? 0 : 1);
  if (spoiled_rows(weights) == 0) weights.clear();
  return weights;
}

AddedNoise at_least(AddedNoise noise, const AddedNoise& least) {
  for (std::size_t part = 0; part < kNoiseParts; ++part) noise[part] = std::max(noise[part], least[part]);
  return noise;
}

struct Fitting {
  bool machine_too = false;
  int max_iterations = 0;
  AddedNoise least{};  // no noise is taken to be below it
};

/// Fits with weights that sharpen until all rows are either in or out. `at.fit` in: of all rows alike.
void sharpen(const RowLikelihood& likelihood, const RowProblem& problem, const RowState& start,
             const Fitting& how, AgreeingFit& at) {
  double scale = 0;
  int settling = 0;
  for (int round = 0; round < kWeightRounds && settling < kSettlingRounds; ++round) {
    at.noise = at_least(median_noise(problem, at.fit.error, at.fit.fitted, at.noise), how.least);
    at.fit = likelihood.fit({start.machine, at.fit.state.around}, at.noise, how.machine_too,
                            how.max_iterations, at.weights);
    const double most = farthest(problem, at.fit);
    scale = std::max(kSharpest, kSharper * (round == 0 ? most : std::min(scale, most)));
    at.weights = softened(problem, at.fit, scale);
    if (scale <= kSharpest) ++settling;
  }
  at.weights = sharp(problem, at.fit);
}

}  // namespace

double spoiled_from(RowKind kind) {
  static const auto limits = [] {
    std::array<double, kMostEquations + 1> of{};
    for (int n = 1; n <= kMostEquations; ++n)
      of[static_cast<std::size_t>(n)] = chi_squared_exceeded(n, kRowSpoiled);
    return of;
  }();
  return limits.at(static_cast<std::size_t>(equations_of(kind)));
}

std::size_t spoiled_rows(const RowWeights& weights) {
  return static_cast<std::size_t>(std::count(weights.begin(), weights.end(), 0.0));
}

AgreeingFit fit_agreeing(const RowLikelihood& likelihood, const RowProblem& problem, const RowState& start,
                         const AddedNoise& noise, bool machine_too, int max_iterations) {
  AgreeingFit at;
  at.noise = noise;
  at.fit = likelihood.fit(start, noise, machine_too, max_iterations);
  sharpen(likelihood, problem, start, {machine_too, max_iterations}, at);
  for (int round = 0; round < kReturnRounds; ++round) {
    at.fit = likelihood.fit_with_noise({start.machine, at.fit.state.around}, at.noise, machine_too,
                                       max_iterations, at.weights);
    const RowWeights next = sharp(problem, at.fit);
    if (next == at.weights) break;
    at.weights = next;
  }
  return at;
}

std::optional<AgreeingFit> fitted_surroundings(const RowLikelihood& likelihood, const RowProblem& problem,
                                               const SurroundingsLayout& layout, const AddedNoise& noise,
                                               int max_iterations) {
  std::optional<AgreeingFit> best;
  for (const Surroundings& start : starts(problem, layout)) {
    AgreeingFit at;
    at.noise = noise;
    at.fit = likelihood.fit({problem.nominal, start}, noise, false, max_iterations);
    if (std::isfinite(at.fit.chi_square) && (!best || at.fit.chi_square < best->fit.chi_square)) best = at;
  }
  if (best && farthest(problem, best->fit) > 1)
    sharpen(likelihood, problem, {problem.nominal, best->fit.state.around}, {false, max_iterations, noise},
            *best);
  return best;
}

}  // namespace understudy::calibration
