#include "studies/calibration/estimator_study_tables.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/quantile.h"
#include "core/units.h"

namespace understudy::studies {
namespace {

using Line = std::function<void(const std::string&)>;

struct ReferenceRow {
  std::size_t poses;
  double bound, bound_chosen, plain, likelihood, chosen_likelihood;     // [um]
  double plain_efficiency, whitened_efficiency, likelihood_efficiency;  // 0: not given
};
constexpr ReferenceRow kReference[] = {
    {7, 837, 35, 303, 303, 28, 0, 0, 0},
    {8, 97, 30, 91, 66, 28, 0, 0, 0},
    {12, 43, 22, 41, 32, 21, 0.47, 0.996, 0.996},
    {24, 21.4, 15.5, 22, 18, 13, 0.54, 1.02, 1.02},
    {50, 13.1, 10.6, 13.8, 12.3, 9.3, 0.59, 0.97, 0},
    {100, 8.9, 7.5, 9.4, 8.4, 7.6, 0, 0, 0},
};

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

/// One estimator over machines.
struct Column {
  std::vector<double> medians;  // [um]
  double excess = 0;            // sum of 1 / efficiency
  int runs = 0, failures = 0, machines = 0;

  void add(const StudyResult& r) {
    runs += r.runs, failures += r.failures;
    if (r.efficiency <= 0) return;
    medians.push_back(to_um(r.median));
    excess += 1 / r.efficiency;
    ++machines;
  }
  double efficiency() const { return machines / excess; }
};

struct Row {
  std::vector<double> bounds, uncalibrated;  // [um], [mm]
  double lowest_bound = 1e9, highest_bound = 0;
  std::vector<Column> columns = std::vector<Column>(3);
};

const std::vector<std::string> kNames{"ik_residual", "whitened", "maximum_likelihood"};

Row run_row(StudySetting setting, const StudyPlan& plan, int machines) {
  Row row;
  for (int m = 1; m <= machines; ++m) {
    setting.seed = static_cast<std::uint64_t>(m);
    const Study study = run_study(setting, plan, kNames);
    if (study.bounds.empty()) continue;
    row.bounds.push_back(to_um(median(study.bounds)));
    row.lowest_bound = std::min(row.lowest_bound, to_um(study.bounds.front()));
    row.highest_bound = std::max(row.highest_bound, to_um(study.bounds.back()));
    row.uncalibrated.push_back(to_mm(study.uncalibrated_median));
    for (std::size_t n = 0; n < kNames.size(); ++n) row.columns[n].add(study.results[n]);
  }
  return row;
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

void efficiency_line(const char* name, const Column& column, double reference, const Line& line) {
  const std::string known = reference > 0 ? text("(%.3f)", reference) : std::string();
  line(text("  %-20s %6.3f %-8s %d runs, %d failed", name, column.efficiency(), known.c_str(), column.runs,
            column.failures));
}

void efficiencies(const std::vector<Row>& rows, const Line& line) {
  line("efficiency, bound^2 / mean squared error, random poses (reference)");
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const ReferenceRow& r = kReference[n];
    if (r.plain_efficiency == 0) continue;
    line(text("%zu poses", r.poses));
    efficiency_line("ik_residual", rows[n].columns[0], r.plain_efficiency, line);
    efficiency_line("whitened", rows[n].columns[1], r.whitened_efficiency, line);
    efficiency_line("maximum_likelihood", rows[n].columns[2], r.likelihood_efficiency, line);
  }
}

}  // namespace

void study_tables(const StudySetting& setting, const TableSize& size, const Line& line) {
  std::vector<Row> random_rows;
  line(text("tip error at poses held out [um], %d machines x %d pose sets x %d draws (reference)",
            size.machines, size.sets, size.draws));
  line("poses  bound RMS, random poses       D-optimal     IK residual   likelihood    D-opt.+likel.");
  for (const ReferenceRow& r : kReference) {
    const Row random = run_row(setting, {r.poses, PoseChoice::random, size.sets, size.draws}, size.machines);
    const Row chosen =
        run_row(setting, {r.poses, PoseChoice::d_optimal, std::max(1, size.sets / 4), size.draws},
                std::min(size.machines, 4));
    line(text("%5zu  %6.1f (%5.1f), %4.0f-%-8.0f %5.1f (%4.1f)  %5.1f (%5.1f) %5.1f (%5.1f)  %5.1f (%4.1f)",
              r.poses, median(random.bounds), r.bound, random.lowest_bound, random.highest_bound,
              median(chosen.bounds), r.bound_chosen, median(random.columns[0].medians), r.plain,
              median(random.columns[2].medians), r.likelihood, median(chosen.columns[2].medians),
              r.chosen_likelihood));
    random_rows.push_back(random);
  }
  line(text("uncalibrated: median %.2f mm", median(random_rows[0].uncalibrated)));
  efficiencies(random_rows, line);
}

}  // namespace understudy::studies
