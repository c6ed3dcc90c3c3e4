#include "sim/as_built/calibrated_draw.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/assert.h"
#include "core/error.h"
#include "core/random.h"
#include "machine/fixture_file.h"
#include "sim/as_built/world_draw.h"

namespace understudy::sim {
namespace {

constexpr const char* kCalibrated = "calibrated";

/// The symmetric square root times unit normals; what rounding left below 0 counts as 0.
Eigen::VectorXd draw(const Eigen::MatrixXd& covariance, std::uint64_t seed, const char* truth) {
  // By correlations: variances of metres and radians differ by orders of magnitude.
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd weight = sigma.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(weight.asDiagonal() * covariance *
                                                             weight.asDiagonal());
  const Eigen::VectorXd spread = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
  Random random(seed, fmt::format("as-built/{}/{}", kCalibrated, truth));
  Eigen::VectorXd unit(covariance.rows());
  for (double& u : unit) u = random.normal();
  return sigma.asDiagonal() *
         (eigen.eigenvectors() * (spread.asDiagonal() * (eigen.eigenvectors().transpose() * unit)));
}

/// Hands out the errors in their order.
class Errors {
 public:
  explicit Errors(Eigen::VectorXd errors) : errors_(std::move(errors)) {}
  double number() { return errors_[next_++]; }
  Vec3 vector() {
    next_ += 3;
    return errors_.segment<3>(next_ - 3);
  }

 private:
  Eigen::VectorXd errors_;
  Eigen::Index next_ = 0;
};

void add_play(const machine::Play& described, double found, std::size_t strut, AsBuilt& built) {
  const double nominal = described.screw_nut + described.ball_joint, total = std::max(0.0, found);
  built.nut_play[strut] = nominal > 0 ? described.screw_nut * total / nominal : total;
  built.ball_play[strut] = nominal > 0 ? described.ball_joint * total / nominal : 0;
}

void add_errors(const machine::HexapodModel& hexapod, const machine::CalibratedParameters& parameters,
                Errors errors, AsBuilt& built) {
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    built.hexapod.base_joint[i] += errors.vector();
    built.hexapod.platform_joint[i] += errors.vector();
    built.hexapod.length_offset[i] += errors.number();
  }
  built.hexapod.deviation = std::abs(built.hexapod.deviation + errors.number());
  for (std::size_t i = 0; parameters.play && i < kinematics::kStruts; ++i)
    add_play(hexapod.play, (*parameters.play)[i] + errors.number(), i, built);
  for (std::size_t i = 0; parameters.lead && i < kinematics::kStruts; ++i)
    built.drives[i].scale = (*parameters.lead)[i] + errors.number();
}

void add_errors(Errors errors, kinematics::Chain& chain) {
  for (Pose* mount : {&chain.X_OT_zero, &chain.X_OS_zero}) {
    const Vec3 p = errors.vector(), w = errors.vector();
    *mount = make_pose(Mat3(exp_rotation(w) * mount->linear()), mount->translation() + p);
  }
  for (kinematics::ChainAxis& axis : chain.axes) {
    axis.direction = (axis.direction + errors.vector()).normalized();
    if (axis.angle) axis.point += errors.vector();
  }
}

}  // namespace

AsBuilt draw_calibrated(const machine::MachineDescription& machine,
                        const machine::CalibratedParameters& parameters, std::uint64_t seed) {
  const bool with_play = parameters.play.has_value(), with_lead = parameters.lead.has_value();
  UNDERSTUDY_ASSERT(
      parameters.covariance.rows() == machine::calibrated_units(machine, with_play, with_lead).size(),
      "the reader of the file takes a covariance of the machine's rows only");
  AsBuilt built = as_described(machine);
  built.source = kCalibrated;
  built.seed = seed;
  Errors errors(draw(parameters.covariance, seed, "geometry"));
  machine.visit([&](const machine::HexapodModel& hexapod) { add_errors(hexapod, parameters, errors, built); },
                [&](const machine::ChainModel&) { add_errors(errors, built.chain); });
  return built;
}

AsBuilt draw_calibrated(const machine::MachineDescription& machine, const TruthSeeds& seeds,
                        const std::string& fixture) {
  constexpr const char* kOthers = "nominal, sampled, manufactured or an as-built file";
  const Place file{machine.file.string(), 0, 0};
  if (!machine.calibration)
    throw InputError(file,
                     fmt::format("as-built calibrated: the machine has no section calibration; write one "
                                 "with understudy calibrate, or ask for {}",
                                 kOthers));
  machine::CalibratedParameters parameters;
  (void)machine::load_machine(machine.file.string(), parameters);
  machine::BuiltTolerances others = machine::load_built_tolerances(machine.file.string(), fixture);
  if (parameters.play) others.play = 0;
  if (parameters.lead) others.lead = 0;
  if (machine.gap_sensor) others.camera_centre = 0;  // found as a turn of the microscope
  if (machine.gap_sensor && machine.gap_sensor->waist)
    others.waist = machine.gap_sensor->waist->sigma / machine.laser.waist_diameter;
  if (parameters.covariance.size() == 0)
    throw InputError(
        file,
        fmt::format("as-built calibrated: the calibration, by {}, has no covariance; calibrate again with "
                    "an estimator that gives one, or ask for {}",
                    machine.calibration->estimator, kOthers));
  AsBuilt built = draw_calibrated(machine, parameters, seeds[TruthGroup::geometry]);
  draw_world(others, seeds, built);
  if (machine.gap_sensor) {
    move_mounting(draw(machine.gap_sensor->covariance, seeds[TruthGroup::mounting], "mounting"), built);
  } else if (machine.tolerances.mounting) {
    draw_mounting(*machine.tolerances.mounting, seeds, built);
  }
  return built;
}

}  // namespace understudy::sim
