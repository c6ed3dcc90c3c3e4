#include "machine/calibrated_parameters.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "machine/calibration_section.h"

namespace understudy::machine {
namespace {

constexpr const char* kCovariance = "covariance_mm_rad";
// The file has ten digits of each number; what they leave of a zero eigenvalue of the correlations is below.
constexpr double kRounding = 1e-7;
constexpr Eigen::Index kMountRows = 6;  // position and rotation vector

[[noreturn]] void refuse(const YamlMap& map, const std::string& why) {
  throw InputError(map.place(kCovariance), fmt::format("{} is not positive semi-definite: {}; write it with "
                                                       "understudy calibrate",
                                                       map.path(kCovariance), why));
}

/// Judged by correlations, for which units do not matter.
void check_semidefinite(const YamlMap& map, const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(covariance.rows());
  for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
    const double variance = covariance(k, k);
    if (variance < 0) refuse(map, fmt::format("the variance of number {} is {:g}", k + 1, variance));
    if (variance > 0) weight[k] = 1 / std::sqrt(variance);
    if (variance == 0 && covariance.row(k).cwiseAbs().maxCoeff() > 0)
      refuse(map, fmt::format("the variance of number {} is 0, its covariances are not", k + 1));
  }
  const Eigen::MatrixXd correlation = weight.asDiagonal() * covariance * weight.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation, Eigen::EigenvaluesOnly);
  const double least = eigen.eigenvalues()[0];
  if (least < -kRounding * static_cast<double>(covariance.rows()))
    refuse(map, fmt::format("an eigenvalue of its correlations is {:.3g}", least));
}

Eigen::MatrixXd symmetric(const std::vector<double>& triangle, const Eigen::VectorXd& units) {
  Eigen::MatrixXd full(units.size(), units.size());
  std::size_t at = 0;
  for (Eigen::Index i = 0; i < units.size(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) full(i, j) = full(j, i) = units[i] * units[j] * triangle[at++];
  return full;
}

/// The rows of this machine; 0 where a schema is recorded and each file has a number of its own.
std::size_t triangle_size(const YamlMap& map, const MachineDescription& machine,
                          const Eigen::VectorXd& units) {
  const bool listed =
      machine.visit([](const HexapodModel&) { return false; },
                    [](const ChainModel& chain) { return chain.kinematics.parameters.empty(); });
  const auto rows = static_cast<std::size_t>(units.size());
  return map.recording() && listed ? 0 : rows * (rows + 1) / 2;
}

}  // namespace

Eigen::VectorXd calibrated_units(const MachineDescription& machine, bool with_play) {
  return machine.visit(
      [&](const HexapodModel&) -> Eigen::VectorXd {
        constexpr Eigen::Index kGeometry = 7 * kinematics::kStruts + 1;  // b_i, a_i, l_i0; dev
        return Eigen::VectorXd::Constant(kGeometry + (with_play ? kinematics::kStruts : 0), kMillimetre);
      },
      [](const ChainModel& model) -> Eigen::VectorXd {
        const auto& axes = model.kinematics.chain.axes;
        Eigen::VectorXd units(2 * kMountRows + 6 * static_cast<Eigen::Index>(axes.size()));
        Eigen::Index rows = 0;
        const auto add = [&](double unit) {
          units.segment<3>(rows).setConstant(unit);
          rows += 3;
        };
        for (int mount = 0; mount < 2; ++mount) add(kMillimetre), add(1);
        for (const kinematics::ChainAxis& axis : axes) {
          add(1);
          if (axis.angle) add(kMillimetre);
        }
        return units.head(rows);
      });
}

CalibratedParameters read_calibrated_parameters(YamlMap& map, const MachineDescription& machine) {
  CalibratedParameters parameters;
  if (!machine.is_chain() && map.has("play_um")) {
    // Below 0 within its uncertainty, where there is none.
    const auto play =
        map.quantities("play_um", kinematics::kStruts, {-2000, 2000}, "total free travel along each strut");
    std::copy_n(play.begin(), kinematics::kStruts, parameters.play.emplace().begin());
  }
  if (!map.has(kCovariance)) return parameters;
  const Eigen::VectorXd units = calibrated_units(machine, parameters.play.has_value());
  const auto triangle =
      map.numbers(kCovariance, triangle_size(map, machine, units), {-1e6, 1e6},
                  "of the numbers of this section: the lower triangle, row by row, in mm and rad");
  if (!map.complete()) return parameters;
  parameters.covariance = symmetric(triangle, units);
  check_semidefinite(map, parameters.covariance);
  return parameters;
}

std::string calibrated_parameters_text(const MachineDescription& machine,
                                       const CalibratedParameters& parameters) {
  std::string out;
  if (parameters.play) {
    out += "  play_um: [";
    for (std::size_t i = 0; i < kinematics::kStruts; ++i)
      out += fmt::format("{}{:.6f}", i > 0 ? ", " : "", to_um((*parameters.play)[i]));
    out += "]\n";
  }
  if (parameters.covariance.size() == 0) return out;
  const Eigen::VectorXd units = calibrated_units(machine, parameters.play.has_value());
  out += fmt::format("  {}: [   # lower triangle; docs/machine-description.md#covariance has the order\n",
                     kCovariance);
  for (Eigen::Index i = 0; i < units.size(); ++i) {
    out += "    ";
    for (Eigen::Index j = 0; j <= i; ++j) {
      if (j > 0) out += ", ";
      out += fmt::format("{:.10g}", parameters.covariance(i, j) / (units[i] * units[j]));
    }
    out += i + 1 < units.size() ? ",\n" : "]\n";
  }
  return out;
}

}  // namespace understudy::machine
