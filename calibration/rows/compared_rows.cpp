#include <algorithm>

#include "calibration/rows/calibrate_rows.h"
#include "calibration/rows/row_report.h"

namespace understudy::calibration {
namespace {

/// `problem` with all that `around` knows by name.
RowProblem with_known(RowProblem problem, const SurroundingsLayout& layout, const Surroundings& around) {
  const SurroundingsLayout wanted(problem);
  // Of a frame that only orientations told, the position is still to be found where new rows need it.
  const auto told = [](const SurroundingsLayout::Slot& slot, const auto& wanted_slots) {
    for (const SurroundingsLayout::Slot& other : wanted_slots)
      if (other.name == slot.name)
        return slot.known ||
               ((other.position < 0 || slot.position >= 0) && (other.turn < 0 || slot.turn >= 0));
    return false;
  };
  const auto keep = [&told](const auto& slots, const auto& wanted_slots, const auto& values, auto& known) {
    for (std::size_t i = 0; i < slots.size(); ++i)
      if (!slots[i].name.empty() && told(slots[i], wanted_slots))
        known.insert_or_assign(slots[i].name, values[i]);
  };
  keep(layout.frames, wanted.frames, around.frames, problem.frames);
  keep(layout.targets, wanted.targets, around.targets, problem.targets);
  keep(layout.points, wanted.points, around.points, problem.points);
  keep(layout.anchors, wanted.anchors, around.anchors, problem.anchors);
  keep(layout.anchors, wanted.anchors, around.zeros, problem.zeros);
  keep(layout.planes, wanted.planes, around.planes, problem.planes);
  for (const auto& slot : layout.anchors) problem.with_zero.erase(slot.name);
  std::erase_if(problem.distances, [&](const KnownDistance& d) {
    return problem.points.contains(d.a) && problem.points.contains(d.b);
  });
  return problem;
}

Eigen::VectorXd left_by(const RowProblem& problem, const RowMachine& machine, const AddedNoise& noise) {
  RowProblem by_machine = problem;
  by_machine.nominal = machine;
  const SurroundingsLayout layout(by_machine);
  const RowLikelihood likelihood(by_machine, layout, {});
  const auto fit = fitted_surroundings(likelihood, by_machine, layout, noise, RowOptions{}.max_iterations);
  return fit ? fit->fit.error : Eigen::VectorXd();
}

}  // namespace

ComparedRows compared_rows(const RowProblem& problem, const RowProblem& from, const RowCalibration& fitted) {
  const SurroundingsLayout layout(from);
  const RowProblem before = with_known(problem, layout, fitted.around_nominal),
                   after = with_known(problem, layout, fitted.around);
  AddedNoise noise = fitted.added;
  for (double& sigma : noise) sigma = std::max(sigma, 1e-6);
  const Eigen::VectorXd nominal = left_by(before, from.nominal, noise),
                        found = left_by(after, fitted.machine, noise);
  if (nominal.size() == 0 || found.size() == 0) return {};
  ComparedRows compared{part_reports(problem, nominal, found, fitted.added), {}};
  int tables = 0;
  for (const MeasurementRow& row : problem.rows) tables = std::max(tables, row.table + 1);
  for (int table = 0; table < tables; ++table) {
    RowWeights weights;
    for (const MeasurementRow& row : problem.rows) weights.push_back(row.table == table ? 1 : 0);
    compared.by_table.push_back(part_reports(problem, nominal, found, fitted.added, weights));
  }
  return compared;
}

}  // namespace understudy::calibration
