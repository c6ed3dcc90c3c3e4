// Rows that do not agree with the others: a broken beam, a target taken for another, a line out of step.
// Weights that go from equal to sharp (graduated non-convexity, Yang et al. 2020) with noise from medians,
// then a fit of the rows that are left, to which rows come back where they agree after all.
#pragma once

#include <optional>

#include "calibration/rows/row_fit.h"

namespace understudy::calibration {

// Of rows without any fault, one in a million is called spoiled where noise is normal.
constexpr double kRowSpoiled = 1e-6;
constexpr double kSpoiledShare = 0.25;  // of the rows; more are no exception but another machine

/// RowFit::apart from which on a row is spoiled: the quantile of chi-square for its equations.
double spoiled_from(RowKind kind);

struct AgreeingFit {
  RowFit fit;
  RowWeights weights;  ///< 1, or 0 of a spoiled row; empty: none is
  AddedNoise noise{};
};

/// `noise` in: where the search for it begins.
AgreeingFit fit_agreeing(const RowLikelihood& likelihood, const RowProblem& problem, const RowState& start,
                         const AddedNoise& noise, bool machine_too, int max_iterations);

/// Rows of `weights` that are spoiled.
std::size_t spoiled_rows(const RowWeights& weights);

/// The surroundings about the nominal machine, from the best of their starts; nothing where none leads to
/// finite numbers. `noise` is the least; rows that are far out do not count.
std::optional<AgreeingFit> fitted_surroundings(const RowLikelihood& likelihood, const RowProblem& problem,
                                               const SurroundingsLayout& layout, const AddedNoise& noise,
                                               int max_iterations);

}  // namespace understudy::calibration
