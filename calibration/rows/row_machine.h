// A machine as rows of measurements see it: where its readings put the tool, and how that changes with its
// parameters. Chains and hexapods are alike behind it.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/problem.h"
#include "calibration/rows/held_columns.h"

namespace understudy::calibration {

/// Readings are the strut lengths [m] that the controller commanded.
struct RowHexapod {
  HexapodGeometry geometry;
  StrutLengths commanded_offset{};    ///< [m], l_i0 as the controller has them
  Pose X_BT_home = Pose::Identity();  ///< where its forward kinematics begins
};

struct RowParameter {
  std::string name;
  bool angle = false;  ///< [rad], else [m]
};

class RowMachine {
 public:
  RowMachine() = default;
  RowMachine(ChainParameters chain) : model_(std::move(chain)) {}  // NOLINT: a chain is one
  RowMachine(RowHexapod hexapod) : model_(std::move(hexapod)) {}   // NOLINT: so is a hexapod

  std::size_t axes() const;
  std::vector<RowParameter> parameters() const;
  /// The tool seen from S (of a hexapod its base B); not finite where no pose has these readings.
  Pose forward(const std::vector<double>& readings) const;
  /// d (tip, rotation) / d parameters, in S. `X_ST` is what forward() says of these readings.
  Eigen::MatrixXd parameter_rows(const std::vector<double>& readings, const Pose& X_ST) const;
  RowMachine moved(const Eigen::VectorXd& by) const;
  /// Which parameters mean anything (free_parameters.h). Struts of a hexapod all move.
  std::vector<Eigen::Index> free_parameters(bool base_free, bool tool_free,
                                            const StationaryAxes& stands = {}) const;

  /// The one that it is, else nothing.
  const ChainParameters* chain() const { return std::get_if<ChainParameters>(&model_); }
  const RowHexapod* hexapod() const { return std::get_if<RowHexapod>(&model_); }

 private:
  std::variant<ChainParameters, RowHexapod> model_;
};

/// Whether a chain's parameter of that name is an angle.
bool is_angle(const std::string& name, const kinematics::Chain& chain);

}  // namespace understudy::calibration
