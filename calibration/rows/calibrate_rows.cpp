#include "calibration/rows/calibrate_rows.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/calibrated.h"
#include "calibration/estimators/independent_columns.h"
#include "calibration/rows/row_report.h"
#include "calibration/rows/shared_error.h"
#include "calibration/rows/surroundings_start.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

RowCalibration refused(RowCalibration result, Status status, const std::string& message) {
  result.status = status;
  result.message = message;
  return result;
}

bool tells_base(const MeasurementRow& row, const RowProblem& problem) {
  switch (row.kind) {
    case RowKind::plane:
      return problem.planes.contains(row.place);
    case RowKind::point:
      return problem.points.contains(row.place);
    case RowKind::distance:
      return problem.anchors.contains(row.place);
    default:
      return row.frame.empty() || problem.frames.contains(row.frame);
  }
}

bool tells_tool(const MeasurementRow& row, const RowProblem& problem) {
  return row.target.empty() || problem.targets.contains(row.target);
}

Fault input_fault(const RowProblem& problem) {
  const std::size_t axes = problem.nominal.axes();
  for (std::size_t j = 0; j < problem.rows.size(); ++j) {
    const MeasurementRow& row = problem.rows[j];
    if (row.axes.size() != axes)
      return fault_of_pose(j, fmt::format("{} axis readings for {} axes", row.axes.size(), axes));
    if (!std::all_of(row.axes.begin(), row.axes.end(), [](double q) { return std::isfinite(q); }))
      return fault_of_pose(j, "an axis reading is not finite");
    if (!row.X_MG.matrix().allFinite() || !std::isfinite(row.distance) || !row.covariance.allFinite())
      return fault_of_pose(j, "a measured number is not finite");
    if (!problem.nominal.forward(row.axes).matrix().allFinite())
      return fault_of_pose(j,
                           "no pose of this machine has these readings: another machine, or another unit?");
  }
  for (const KnownDistance& d : problem.distances)
    for (const std::string& name : {d.a, d.b})
      if (std::none_of(problem.rows.begin(), problem.rows.end(), [&](const MeasurementRow& row) {
            return row.kind == RowKind::point && row.place == name;
          }))
        return {fmt::format("a distance is given to point '{}', which no row names", name), {}};
  return {};
}

/// Numbers of the surroundings that rows cannot tell apart, whatever the machine.
std::vector<std::string> untold_surroundings(const RowProblem& problem, const SurroundingsLayout& layout,
                                             const RowState& at, const AddedNoise& noise,
                                             const RowWeights& weights) {
  RowEquations equations = row_equations(problem, layout, at, false);
  whiten(problem, noise, equations);
  const auto first = first_equations(problem);
  for (std::size_t j = 0; j < weights.size(); ++j)
    if (weights[j] == 0 && equations.around.cols() > 0)
      equations.around.middleRows(first[j], first[j + 1] - first[j]).setZero();
  const auto kept = independent_columns(equations.around);
  std::vector<std::string> names;
  for (Index k = 0; k < layout.columns(); ++k)
    if (!std::binary_search(kept.begin(), kept.end(), k))
      names.push_back(layout.names[static_cast<std::size_t>(k)]);
  return names;
}

std::vector<Eigen::VectorXd> by_rows(const RowProblem& problem, const Eigen::VectorXd& all) {
  const auto first = first_equations(problem);
  std::vector<Eigen::VectorXd> rows;
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    rows.emplace_back(all.segment(first[j], equations_of(problem.rows[j].kind)));
  return rows;
}

Eigen::VectorXd whitened(const RowProblem& problem, const AddedNoise& noise, const Eigen::VectorXd& error) {
  RowEquations equations;
  equations.error = error;
  equations.machine.resize(error.size(), 0);
  equations.around.resize(error.size(), 0);
  whiten(problem, noise, equations);
  return equations.error;
}

/// Where the told noise does not explain the residuals: how much more the uncertainties hold.
void warn_of_noise(RowCalibration& result) {
  for (const PartReport& part : result.parts) {
    if (!part.told || part.added <= 0) continue;
    const bool angle = part.name == "turn";
    result.warnings.push_back(
        fmt::format("{} residuals are more than the told noise explains: {:.3g} {} on each axis were added "
                    "to it (outliers, "
                    "play, bending?)",
                    part.name, (angle ? 1e3 : 1e6) * part.added, angle ? "mrad" : "um"));
  }
}

struct Asked {
  std::vector<Index> machine;
  std::vector<std::string> estimated, redundant;
  StationaryAxes stands;
};

/// Axes of a chain whose readings are all the same but for what a controller's resting jitters.
StationaryAxes stationary_axes(const RowProblem& problem) {
  constexpr double kStands = 1e-3;  // [m] or [rad]
  StationaryAxes stands;
  if (!problem.nominal.chain()) return stands;
  for (std::size_t i = 0; i < problem.nominal.axes(); ++i) {
    double low = problem.rows.front().axes[i], high = low;
    for (const MeasurementRow& row : problem.rows) {
      low = std::min(low, row.axes[i]);
      high = std::max(high, row.axes[i]);
    }
    stands.push_back(high - low < kStands ? std::optional((low + high) / 2) : std::nullopt);
  }
  return stands;
}

Asked unknowns_of(const RowProblem& problem) {
  const auto any = [&](bool (*tells)(const MeasurementRow&, const RowProblem&)) {
    return std::any_of(problem.rows.begin(), problem.rows.end(),
                       [&](const MeasurementRow& row) { return tells(row, problem); });
  };
  Asked unknowns;
  unknowns.stands = stationary_axes(problem);
  unknowns.machine = problem.nominal.free_parameters(!any(tells_base), !any(tells_tool), unknowns.stands);
  const auto parameters = problem.nominal.parameters();
  for (std::size_t k = 0; k < parameters.size(); ++k)
    (std::binary_search(unknowns.machine.begin(), unknowns.machine.end(), static_cast<Index>(k))
         ? unknowns.estimated
         : unknowns.redundant)
        .push_back(parameters[k].name);
  return unknowns;
}

void fill(const RowProblem& problem, const SurroundingsLayout& layout, const RowFit& before,
          const AgreeingFit& agreeing, RowCalibration& result) {
  const RowFit& after = agreeing.fit;
  const AddedNoise& noise = agreeing.noise;
  for (std::size_t j = 0; j < agreeing.weights.size(); ++j) result.used[j] = agreeing.weights[j] > 0;
  result.spoiled = spoiled_list(problem, after, agreeing.weights);
  result.machine = after.state.machine;
  result.around = after.state.around;
  result.around_nominal = before.state.around;
  result.iterations = after.iterations;
  result.chi_square = after.chi_square;
  result.added = noise;
  result.before = by_rows(problem, before.error);
  result.after = by_rows(problem, after.error);
  result.whitened = by_rows(problem, whitened(problem, noise, after.error));
  result.parts = part_reports(problem, before.error, after.error, noise, agreeing.weights);
  result.found = found_numbers(layout, after.state.around, after.covariance);
}

}  // namespace

RowCalibration calibrate_rows(const RowProblem& problem, const RowOptions& options) {
  RowCalibration result;
  result.machine = problem.nominal;
  result.used.assign(problem.rows.size(), true);
  if (const Fault fault = input_fault(problem); !fault.message.empty()) {
    result.pose = fault.pose;
    return refused(result, Status::bad_input, fault.message);
  }
  const SurroundingsLayout layout(problem);
  const Asked unknowns = unknowns_of(problem);
  result.redundant = unknowns.redundant;
  const Index equations = first_equations(problem).back() + static_cast<Index>(problem.distances.size());
  const Index numbers = layout.columns() + static_cast<Index>(options.machine ? unknowns.machine.size() : 0);
  if (equations < numbers)
    return refused(
        result, Status::too_few_poses,
        fmt::format("{} rows give {} equations, fewer than the {} unknown numbers ({} of the machine, {} "
                    "of frames, targets and places): measure more",
                    problem.rows.size(), equations, numbers, numbers - layout.columns(), layout.columns()));
  const RowLikelihood likelihood(problem, layout, unknowns.machine);
  tell(options.progress, 0, 10, "fitting the measuring frames");
  const auto before = fitted_surroundings(likelihood, problem, layout, options.start, options.max_iterations);
  if (!before)
    return refused(result, Status::not_converged, "no place of the measuring frames fits these rows");
  const auto untold = [&](const RowState& at, const AddedNoise& noise, const RowWeights& weights) {
    const auto names = untold_surroundings(problem, layout, at, noise, weights);
    if (names.empty()) return false;
    result = refused(result, Status::rank_deficient,
                     fmt::format("these rows do not tell {}: turn the tool about several directions and move "
                                 "it between rows, or say where it is",
                                 fmt::join(names, ", ")));
    return true;
  };
  if (untold(before->fit.state, options.start, {})) return result;
  tell(options.progress, 3, 10, fmt::format("fitting {} rows", problem.rows.size()));
  AgreeingFit agreeing = fit_agreeing(likelihood, problem, {problem.nominal, before->fit.state.around},
                                      options.start, options.machine, options.max_iterations);
  const RowFit& after = agreeing.fit;
  if (const std::size_t spoiled = spoiled_rows(agreeing.weights);
      static_cast<double>(spoiled) > kSpoiledShare * static_cast<double>(problem.rows.size()))
    return refused(
        result, Status::not_converged,
        fmt::format("{} of {} rows do not agree with the others, more than a quarter: readings and "
                    "measurements of the same rows, of this machine, with one target each?",
                    spoiled, problem.rows.size()));
  if (untold(after.state, agreeing.noise, agreeing.weights)) return result;
  tell(options.progress, 9, 10, "comparing with the nominal machine");
  // What the nominal machine leaves, weighed as the found one is.
  const RowFit compared = likelihood.fit({problem.nominal, before->fit.state.around}, agreeing.noise, false,
                                         options.max_iterations, agreeing.weights);
  if (options.machine) {
    const SharedError shared =
        shared_error(problem, layout, likelihood.unknowns(), after, agreeing.noise, agreeing.weights);
    result.shared = shared.share;
    agreeing.fit.covariance = shared.covariance;
  }
  fill(problem, layout, compared, agreeing, result);
  if (options.machine) result.estimated = unknowns.estimated;
  const Index machine = options.machine ? likelihood.prior().size() : 0;
  result.covariance = after.covariance.topLeftCorner(machine, machine);
  result.target_sigmas = target_sigmas(problem, layout, likelihood.unknowns(), after);
  result.changes = after.moved.head(machine);
  name_untold(result.estimated, result.covariance, likelihood.prior().head(machine), result);
  // Unknowns that the prior tells count as none.
  const double by_prior =
      result.covariance.diagonal().cwiseQuotient(likelihood.prior().head(machine).cwiseAbs2()).sum();
  Index used = equations;
  for (const SpoiledRow& row : result.spoiled) used -= equations_of(problem.rows[row.row].kind);
  result.degrees_of_freedom = static_cast<int>(std::lround(static_cast<double>(used - numbers) + by_prior));
  if (!after.settled)
    return refused(
        result, Status::not_converged,
        fmt::format("the search did not settle after {} iterations: are the readings and measurements of "
                    "the same rows, and the machine the right one?",
                    after.iterations));
  warn_of_noise(result);
  for (std::size_t i = 0; i < unknowns.stands.size(); ++i)
    if (unknowns.stands[i] && options.machine)
      result.warnings.push_back(fmt::format(
          "axis {} stands still in all rows: it stays as drawn, and the uncertainties hold only where "
          "it stands there",
          problem.nominal.chain()->chain.axes[i].name));
  result.status = Status::ok;
  return result;
}

}  // namespace understudy::calibration
