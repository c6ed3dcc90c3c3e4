#include "calibration/machine/compared_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::calibration {
namespace {

constexpr double kWorse = 1.02;  // of what the drawing leaves

bool is_map(const std::string& file) { return file.ends_with(".yaml") || file.ends_with(".yml"); }

/// RMS over the values of both.
void pool(const std::vector<PartReport>& more, std::vector<PartReport>& all) {
  const auto mean = [](double a, int n, double b, int m) {
    return std::sqrt((a * a * n + b * b * m) / (n + m));
  };
  for (const PartReport& part : more) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const PartReport& p) { return p.name == part.name; });
    if (same == all.end()) {
      all.push_back(part);
      continue;
    }
    same->before = mean(same->before, same->values, part.before, part.values);
    same->after = mean(same->after, same->values, part.after, part.values);
    same->values += part.values;
    same->equations += part.equations;
    same->told = same->told && part.told;
  }
}

void warn_where_worse(const ComparedFile& file, MachineCalibration& result) {
  for (const PartReport& part : file.parts) {
    if (part.after <= kWorse * part.before) continue;
    const bool turn = part.name == "turn";
    const double unit = turn ? 1e3 : 1e6;
    result.warnings.push_back(fmt::format(
        "{}: the calibration makes these rows worse, {} residuals are {:.1f} {} RMS by the drawing and "
        "{:.1f} "
        "after: the fitted rows tell too little of the machine (measure more postures, all over its range, "
        "or "
        "say with --prior how near its drawing it is), or these rows are of another machine, frame or target",
        file.file, part.name, unit * part.before, turn ? "mrad" : "um", unit * part.after));
  }
}

}  // namespace

void assume_noise(const std::optional<MeasurementNoise>& noise, RowProblem& problem) {
  if (!noise) return;
  for (MeasurementRow& row : problem.rows) {
    if (row.noise_told) continue;
    row.covariance = noise->covariance();
    row.noise_told = true;
  }
}

void compare_tables(const RowsRequest& request, const MeasuredRows& fitted, const RowCalibration& found,
                    const machine::MachineDescription& nominal, MachineCalibration& result) {
  std::vector<MeasuredRows> groups;
  std::vector<std::string> tables;
  for (const std::string& file : request.compared) {
    if (is_map(file))
      groups.push_back(read_measured_rows(read_column_map(file), {}, nominal));
    else
      tables.push_back(file);
  }
  if (!tables.empty())
    groups.insert(groups.begin(), read_measured_rows(request.map, tables, nominal, fitted.files));
  for (MeasuredRows& rows : groups) {
    assume_noise(request.noise, rows.problem);
    const ComparedRows compared = compared_rows(rows.problem, fitted.problem, found);
    pool(compared.all, result.compared);
    for (std::size_t i = 0; i < compared.by_table.size(); ++i)
      result.compared_files.push_back({rows.files[i], compared.by_table[i]});
    result.notes.insert(result.notes.end(), rows.notes.begin(), rows.notes.end());
  }
  for (const ComparedFile& file : result.compared_files) warn_where_worse(file, result);
}

}  // namespace understudy::calibration
