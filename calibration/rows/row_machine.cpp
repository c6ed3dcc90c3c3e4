#include "calibration/rows/row_machine.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "calibration/rows/free_parameters.h"
#include "calibration/strut_model.h"

namespace understudy::calibration {
namespace {

PoseSample sample_at(const RowHexapod& machine, const std::vector<double>& readings) {
  PoseSample sample;
  for (std::size_t i = 0; i < kStruts; ++i)
    sample.displacement[i] = readings[i] - machine.commanded_offset[i];
  return sample;
}

Pose nowhere() {
  Pose X;
  X.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  return X;
}

Pose reached(const RowHexapod& machine, const std::vector<double>& readings) {
  const HexapodParameters parameters{machine.geometry, {}};
  const auto found = kinematics::forward(
      machine.geometry, strut_lengths(parameters, sample_at(machine, readings)), machine.X_BT_home);
  return found.status == kinematics::SolveStatus::ok ? found.X_BT : nowhere();
}

std::vector<RowParameter> hexapod_parameters() {
  std::vector<RowParameter> list;
  for (std::size_t i = 1; i <= kStruts; ++i) {
    for (const char* joint : {"base", "platform"})
      for (const char axis : {'x', 'y', 'z'}) list.push_back({fmt::format("{} joint {} {}", joint, i, axis)});
    list.push_back({fmt::format("length offset {}", i)});
  }
  return list;
}

}  // namespace

bool is_angle(const std::string& name, const kinematics::Chain& chain) {
  if (name.find("turn") != std::string::npos || name.find("tilt") != std::string::npos) return true;
  return std::any_of(chain.axes.begin(), chain.axes.end(),
                     [&](const auto& axis) { return name == axis.name + " zero" && axis.angle; });
}

std::size_t RowMachine::axes() const { return chain() ? chain()->chain.axes.size() : kStruts; }

std::vector<RowParameter> RowMachine::parameters() const {
  if (!chain()) return hexapod_parameters();
  std::vector<RowParameter> list;
  for (const std::string& name : chain_parameter_names(chain()->chain))
    list.push_back({name, is_angle(name, chain()->chain)});
  return list;
}

Pose RowMachine::forward(const std::vector<double>& readings) const {
  return chain() ? calibration::forward(*chain(), readings) : reached(*hexapod(), readings);
}

Eigen::MatrixXd RowMachine::parameter_rows(const std::vector<double>& readings, const Pose& X_ST) const {
  if (chain()) return chain_rows(*chain(), readings);
  StrutLinearisation at;
  if (!X_ST.matrix().allFinite() ||
      !linearise({hexapod()->geometry, {}}, sample_at(*hexapod(), readings), X_ST, at))
    return Eigen::MatrixXd::Constant(6, kGeometryParameters, std::numeric_limits<double>::quiet_NaN());
  return pose_rows(at, {});
}

RowMachine RowMachine::moved(const Eigen::VectorXd& by) const {
  if (chain()) return calibration::moved(*chain(), by);
  RowHexapod to = *hexapod();
  to.geometry = calibration::moved({to.geometry, {}}, by, {}).geometry;
  return to;
}

std::vector<Eigen::Index> RowMachine::free_parameters(bool base_free, bool tool_free,
                                                      const StationaryAxes& stands) const {
  return chain() ? calibration::free_parameters(*chain(), base_free, tool_free, stands)
                 : calibration::free_parameters(hexapod()->geometry, base_free, tool_free);
}

}  // namespace understudy::calibration
