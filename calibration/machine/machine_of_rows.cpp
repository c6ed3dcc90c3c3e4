#include "calibration/machine/machine_of_rows.h"

#include <algorithm>

#include "calibration/absorb_zeros.h"
#include "calibration/machine/calibrate_hexapod.h"
#include "calibration/machine/estimation_report.h"
#include "calibration/machine/stored_parameters.h"
#include "core/units.h"
#include "machine/file/calibration_section.h"

namespace understudy::calibration {
namespace {

void take_chain(const RowCalibration& found, const machine::MachineDescription& nominal,
                MachineCalibration& result, const Progress& progress) {
  ChainCalibration chain;
  static_cast<Estimation&>(chain) = found;
  chain.parameters = *found.machine.chain();
  chain.estimated = found.estimated;
  chain.redundant = found.redundant;
  chain.covariance = found.covariance;
  kinematics::ChainDescription& known = result.machine.chain().kinematics;
  if (known.design.axes.empty()) known.design = known.chain;
  known.chain = absorb_zeros(chain.parameters);
  result.stored = stored_parameters(chain, Measurements{}, result.machine);
  result.machine.X_BT_home = kinematics::forward(known.chain, known.home);
  result.tip = tip_map(nominal, result.machine, chain_tip(result.machine, chain), progress);
}

/// Numbers of `estimated` among all of the machine's parameters.
std::vector<Eigen::Index> columns_of(const RowCalibration& found) {
  const auto all = found.machine.parameters();
  std::vector<Eigen::Index> columns;
  for (const std::string& name : found.estimated)
    columns.push_back(std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; }) -
                      all.begin());
  return columns;
}

void take_hexapod(const RowCalibration& found, const machine::MachineDescription& nominal,
                  MachineCalibration& result, const Progress& progress) {
  Calibration hexapod;
  static_cast<Estimation&>(hexapod) = found;
  hexapod.parameters.geometry = found.machine.hexapod()->geometry;
  hexapod.covariance = ParameterMatrix::Zero(kGeometryParameters, kGeometryParameters);
  const auto columns = columns_of(found);
  hexapod.covariance(columns, columns) = found.covariance;
  result.machine.hexapod().geometry = hexapod.parameters.geometry;
  result.stored = stored_parameters(hexapod, {}, Measurements{}, result.machine);
  result.tip = tip_map(nominal, result.machine, hexapod_tip(result.machine, hexapod, {}), progress);
}

double value(const HexapodGeometry& geometry, Eigen::Index parameter) {
  const auto i = static_cast<std::size_t>(parameter / kStrutParameters);
  const Eigen::Index k = parameter % kStrutParameters;
  return k < 3   ? geometry.base_joint[i][k]
         : k < 6 ? geometry.platform_joint[i][k - 3]
                 : geometry.length_offset[i];
}

/// From 0, the drawing: parameters of axes have no other value. Those of a hexapod are lengths of its
/// drawing.
std::vector<ParameterLine> parameter_lines(const RowCalibration& found, const RowMachine& drawn) {
  const auto all = drawn.parameters();
  const auto columns = columns_of(found);
  std::vector<ParameterLine> lines;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const RowParameter& parameter = all[static_cast<std::size_t>(columns[k])];
    const double unit = parameter.angle ? kDegree : kMillimetre;
    const double before = drawn.hexapod() ? value(drawn.hexapod()->geometry, columns[k]) / unit : 0;
    lines.push_back({parameter.name, parameter.angle ? "deg" : "mm", before,
                     before + found.changes[static_cast<Eigen::Index>(k)] / unit,
                     sigma_of(found.covariance, k) / unit});
  }
  return lines;
}

}  // namespace

void require_row_model(const machine::MachineDescription& nominal, MachineCalibration& result) {
  machine::require_calibratable(nominal);
  if (!nominal.is_chain()) check_hexapod_model(nominal, result.file, result);
}

void take_machine(const RowCalibration& found, const RowProblem& problem,
                  const machine::MachineDescription& nominal, MachineCalibration& result,
                  const Progress& progress) {
  if (found.machine.chain())
    take_chain(found, nominal, result, progress);
  else
    take_hexapod(found, nominal, result, progress);
  result.parameters = parameter_lines(found, problem.nominal);
  report_estimation(found, found.covariance, result);
}

}  // namespace understudy::calibration
