#include "machine/calibrated_parameters.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "machine/file/calibration_section.h"
#include "machine/file/covariance_key.h"

namespace understudy::machine {
namespace {

constexpr const char* kCovariance = "covariance_mm_rad";
constexpr double kPermille = 1e-3;
constexpr Eigen::Index kMountRows = 6;  // position and rotation vector

/// Each file has a number of rows of its own.
bool rows_are_listed(const MachineDescription& machine) {
  return machine.visit([](const HexapodModel&) { return false; },
                       [](const ChainModel& chain) { return chain.kinematics.parameters.empty(); });
}

std::string list_text(const char* key, const kinematics::PerStrut<double>& values, double unit) {
  std::string out = fmt::format("  {}: [", key);
  for (std::size_t i = 0; i < values.size(); ++i)
    out += fmt::format("{}{:.6f}", i > 0 ? ", " : "", values[i] / unit);
  return out + "]\n";
}

}  // namespace

Eigen::VectorXd calibrated_units(const MachineDescription& machine, bool with_play, bool with_lead) {
  return machine.visit(
      [&](const HexapodModel&) -> Eigen::VectorXd {
        constexpr Eigen::Index kGeometry = 7 * kinematics::kStruts + 1;  // b_i, a_i, l_i0; dev
        const Eigen::Index lengths = kGeometry + (with_play ? kinematics::kStruts : 0);
        Eigen::VectorXd units =
            Eigen::VectorXd::Constant(lengths + (with_lead ? kinematics::kStruts : 0), kMillimetre);
        units.tail(units.size() - lengths).setConstant(kPermille);
        return units;
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
  if (!machine.is_chain() && map.has("lead_permille")) {
    const auto lead = map.quantities("lead_permille", kinematics::kStruts, {-500, 500},
                                     "of its travel that each strut goes farther than its motor says");
    std::copy_n(lead.begin(), kinematics::kStruts, parameters.lead.emplace().begin());
  }
  if (!map.has(kCovariance)) return parameters;
  parameters.covariance = read_covariance(
      map, kCovariance, calibrated_units(machine, parameters.play.has_value(), parameters.lead.has_value()),
      "understudy calibrate", rows_are_listed(machine));
  return parameters;
}

std::string calibrated_parameters_text(const MachineDescription& machine,
                                       const CalibratedParameters& parameters) {
  std::string out;
  if (parameters.play) out += list_text("play_um", *parameters.play, kMicrometre);
  if (parameters.lead) out += list_text("lead_permille", *parameters.lead, kPermille);
  if (parameters.covariance.size() == 0) return out;
  return out +
         covariance_text(kCovariance, parameters.covariance,
                         calibrated_units(machine, parameters.play.has_value(), parameters.lead.has_value()),
                         "docs/machine-description.md#covariance");
}

}  // namespace understudy::machine
