#include "calibration/machine/calibrate_measured_rows.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/machine/axis_signs.h"
#include "calibration/machine/compared_tables.h"
#include "calibration/machine/machine_of_rows.h"
#include "calibration/machine/measurement_columns.h"
#include "calibration/table/measured_rows.h"
#include "core/error.h"
#include "core/text/some_of.h"
#include "core/units.h"
#include "machine/file/calibration_section.h"

namespace understudy::calibration {
namespace {

// Rows that a calibrated machine still misses by so much (RMS) are not this machine's.
constexpr double kUnexplained = 20e-3;     // [m]
constexpr double kUnexplainedTurn = 0.15;  // [rad]

/// The row's numbers where a whole pose has them.
Twist as_pose(RowKind kind, const Eigen::VectorXd& numbers) {
  Twist pose = Twist::Constant(std::numeric_limits<double>::quiet_NaN());
  pose.segment(kind == RowKind::orientation ? 3 : 0, numbers.size()) = numbers;
  return pose;
}

void check_explained(const RowCalibration& found, const std::string& file, const std::string& machine) {
  for (const PartReport& part : found.parts) {
    const bool turn = part.name == "turn";
    if (part.after <= (turn ? kUnexplainedTurn : kUnexplained)) continue;
    throw InputError(
        {file, 0, 0},
        fmt::format("no calibration of {} explains these rows: {} residuals stay at {:.1f} {} RMS; "
                    "another machine, or rows of measurements and joints that do not belong together?",
                    machine, part.name, turn ? to_deg(part.after) : to_mm(part.after), turn ? "deg" : "mm"));
  }
}

void check_signs(const RowProblem& problem, const RowCalibration& found, const std::string& file) {
  const auto turned = turned_axis(problem, found);
  if (!turned) return;
  const double unit = turned->angle ? 1e-3 : kMillimetre;
  const char* name = turned->angle ? "mrad" : "mm";
  throw InputError(
      {file, 0, 0},
      fmt::format("the rows fit this machine far better where axis {} counts the other way ({:.2f} {} "
                  "RMS instead of {:.2f}): write -1 for it in `signs` of the map's joints",
                  turned->name, turned->after / unit, name, turned->before / unit));
}

/// Machine files refuse axes that are farther from their drawing.
void check_drawing(const RowCalibration& found, const std::string& file) {
  const ChainParameters* chain = found.machine.chain();
  for (std::size_t k = 0; chain && k < found.estimated.size(); ++k) {
    const double by = std::abs(found.changes[static_cast<Eigen::Index>(k)]);
    if (found.estimated[k].find(" tilt ") == std::string::npos || by <= machine::kTurnedFromDrawing) continue;
    throw InputError(
        {file, 0, 0},
        fmt::format("these rows turn '{}' by {:.1f} deg from its drawing, more than {:.1f}, as no "
                    "machine is built: measure more postures, or say with --prior how near its "
                    "drawing it is (--prior 1,0.3)",
                    found.estimated[k], to_deg(by), to_deg(machine::kTurnedFromDrawing)));
  }
}

void check_answer(const RowCalibration& found, const MeasuredRows& rows) {
  if (found.ok()) return;
  Place place{rows.files.front(), 0, 0};
  if (found.pose) {
    const MeasurementRow& row = rows.problem.rows[*found.pose];
    place = {rows.files[static_cast<std::size_t>(row.table)], row.line, 0};
  }
  throw InputError(place, found.message);
}

void take_rows(const MeasuredRows& rows, const RowCalibration& found, MachineCalibration& result) {
  for (std::size_t j = 0; j < rows.problem.rows.size(); ++j) {
    const MeasurementRow& row = rows.problem.rows[j];
    PoseResidual residual;
    residual.line = row.line;
    residual.used = found.used[j];
    residual.before = as_pose(row.kind, found.before[j]);
    residual.after = as_pose(row.kind, found.after[j]);
    residual.whitened = as_pose(row.kind, found.whitened[j]);
    result.poses.push_back(residual);
  }
  result.noise_given = std::all_of(rows.problem.rows.begin(), rows.problem.rows.end(),
                                   [](const MeasurementRow& row) { return row.noise_told; });
  result.parts = found.parts;
  result.found = found.found;
  result.untold = found.untold;
  result.untold_together = found.untold_together;
  for (const SpoiledRow& spoiled : found.spoiled) {
    const MeasurementRow& row = rows.problem.rows[spoiled.row];
    result.spoiled.push_back({rows.files[static_cast<std::size_t>(row.table)], row.line, to_string(row.kind),
                              spoiled.sigmas, spoiled.length, spoiled.turn});
  }
  result.redundant = found.redundant;
  result.shared = found.shared;
  result.target_sigmas = found.target_sigmas;
  result.notes = rows.notes;
  const SurroundingsLayout layout(rows.problem);
  for (std::size_t i = 0; i < layout.planes.size(); ++i) {
    const Vec3& normal = found.around.planes[i].normal;
    result.notes.push_back(fmt::format("plane {}: normal {:.6f}, {:.6f}, {:.6f}", layout.planes[i].name,
                                       normal.x(), normal.y(), normal.z()));
  }
}

std::vector<std::string> spoiled_lines(const MachineCalibration& result) {
  std::vector<std::string> places;
  for (const SpoiledLine& row : result.spoiled) places.push_back(fmt::format("{}:{}", row.file, row.line));
  return places;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    std::erase_if(cell, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    cells.push_back(cell);
  }
  return cells;
}

}  // namespace

MachineCalibration calibrate_measured_rows(const RowsRequest& request) {
  MachineCalibration result;
  const machine::MachineDescription nominal = machine::load_machine(request.machine);
  result.file = request.map.file;
  require_row_model(nominal, result);
  MeasuredRows rows = read_measured_rows(request.map, request.measurements, nominal, request.compared);
  assume_noise(request.noise, rows.problem);
  rows.problem.prior = request.prior;
  const RowCalibration found = calibrate_rows(rows.problem, {.progress = stage_of(request.progress, 0, 0.7)});
  check_answer(found, rows);
  check_signs(rows.problem, found, rows.files.front());
  check_explained(found, rows.files.front(), nominal.name);

  check_drawing(found, rows.files.front());

  result.machine = nominal;
  result.file = rows.files.front();
  result.command = request.command;
  result.estimator = "rows";
  take_rows(rows, found, result);
  take_machine(found, rows.problem, nominal, result, stage_of(request.progress, 0.7, 1));
  if (!result.spoiled.empty())
    result.warnings.push_back(fmt::format("{} of {} rows do not agree with the others and were left out: {}",
                                          result.spoiled.size(), rows.problem.rows.size(),
                                          some_of(spoiled_lines(result), 8)));
  compare_tables(request, rows, found, nominal, result);
  result.machine.calibration = {"rows", std::filesystem::path(rows.files.front()).filename().string(),
                                rows.sha256, static_cast<int>(rows.problem.rows.size()), result.tip.rms};
  return result;
}

std::optional<ColumnMap> map_of_partial_poses(const std::string& text, const std::string& file,
                                              const std::string& machine_name) {
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line) && (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#')) {
  }
  const std::vector<std::string> header = cells_of(line);
  const auto has = [&](const std::string& name) {
    return std::find(header.begin(), header.end(), name) != header.end();
  };
  const bool position = has("x_mm") && has("y_mm") && has("z_mm");
  const bool orientation = has("qw") && has("qx") && has("qy") && has("qz");
  const auto any = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), has);
  };
  if (position == orientation || (position ? any({"qw", "qx", "qy", "qz"}) : any({"x_mm", "y_mm", "z_mm"})))
    return std::nullopt;
  const machine::MachineDescription machine = machine::load_machine(machine_name);
  std::vector<std::string> known{"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz", "sigma_um", "sigma_mrad"};
  TableMap table;
  table.read = {file, text};
  table.kind = position ? RowKind::position : RowKind::orientation;
  table.format = {',', '.', 1, "#", 0};
  table.joints = {axis_columns(machine), kDegree, true, {}, 1};  // lengths of struts and slides are in mm
  table.joint_unit_told = true;
  known.insert(known.end(), table.joints.columns.begin(), table.joints.columns.end());
  for (const std::string& name : header)
    if (std::find(known.begin(), known.end(), name) == known.end())
      return std::nullopt;  // read_measurements() says why
  if (position) table.position = {{"x_mm", "y_mm", "z_mm"}, kMillimetre, true, {}, kMicrometre};
  if (orientation) table.orientation = {{"qw", "qx", "qy", "qz"}, 1, true, {}, 1e-3};
  if (position && has("sigma_um")) table.position->sigma = {"sigma_um"};
  if (orientation && has("sigma_mrad")) table.orientation->sigma = {"sigma_mrad"};
  ColumnMap map;
  map.file = file;
  map.tables.push_back(table);
  return map;
}

}  // namespace understudy::calibration
