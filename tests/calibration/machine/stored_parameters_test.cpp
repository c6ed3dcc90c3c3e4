// The covariance in the calibrated file says of the tip what the calibration's own map says (tip_map.h), by a
// way of its own: derivatives of the forward kinematics by the numbers of the file.
#include "calibration/machine/stored_parameters.h"

#include <functional>

#include <gtest/gtest.h>

#include "calibration/absorb_zeros.h"
#include "calibration/estimators/estimator.h"
#include "calibration/machine/tip_map.h"
#include "machine/file/calibration_section.h"
#include "tests/calibration/machine/measured_machine.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

// Central differences of lengths near 0.2 m and turns, at a step of 1e-6: rounding is 1e-10 of the
// derivative, curvature less; parameters that cancel each other raise it by their sigma over the tip's, some
// 100.
constexpr double kDifferences = 1e-6;
constexpr double kStep = 1e-6;

Eigen::Matrix3Xd derivatives(const std::function<Vec3(const Eigen::VectorXd&)>& tip, Eigen::Index rows) {
  Eigen::Matrix3Xd columns(3, rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(rows, k);
    columns.col(k) = (tip(step) - tip(-step)) / (2 * kStep);
  }
  return columns;
}

void expect_same(const Mat3& stored, const Mat3& stated) {
  EXPECT_LT((stored - stated).norm(), kDifferences * stated.norm()) << stored << "\n\n" << stated;
}

/// Measured in a frame that may be off by 30 um and 0.3 mrad; its scale is exact.
Measurements measured(const machine::MachineDescription& drawn, std::size_t count) {
  Measurements table = BuiltMachine(drawn, 3).measured(drawn, count);
  table.frame = {30e-6, 0.3e-3, 0};
  return table;
}

Vec3 middle(const Measurements& table) {
  Vec3 sum = Vec3::Zero();
  for (const MeasuredPose& pose : table.poses) sum += pose.X_WT.translation();
  return sum / static_cast<double>(table.poses.size());
}

/// Off home, so that all numbers matter.
Pose some_pose(const machine::MachineDescription& machine) {
  return make_pose(Mat3(exp_rotation(Vec3(0.1, -0.07, 0.05)) * machine.X_BT_home.linear()),
                   machine.X_BT_home.translation() + Vec3(10e-3, -15e-3, 12e-3));
}

TEST(StoredParameters, OfAHexapodMoveTheTipAsStated) {
  const auto drawn = machine::load_machine("hexapod");
  const Measurements table = measured(drawn, 16);
  const Calibration found = make_maximum_likelihood()->calibrate(hexapod_problem(table, drawn));
  ASSERT_TRUE(found.ok()) << found.message;
  auto known = drawn;
  known.hexapod().geometry = found.parameters.geometry;
  const auto stored = stored_parameters(found, {}, table, known);
  ASSERT_EQ(stored.covariance.rows(), 43);
  EXPECT_EQ(stored.covariance.row(42).norm(), 0) << "dev was not estimated";
  EXPECT_FALSE(stored.play);

  const Pose X_BT = some_pose(known);
  kinematics::StrutLengths lengths{};
  const auto& geometry = found.parameters.geometry;
  ASSERT_EQ(kinematics::inverse(geometry, X_BT, lengths), kinematics::SolveStatus::ok);
  const auto tip = [&](const Eigen::VectorXd& by) -> Vec3 {
    auto g = geometry;
    auto l = lengths;
    for (std::size_t i = 0; i < kStruts; ++i) {
      const Eigen::Index row = 7 * static_cast<Eigen::Index>(i);
      g.base_joint[i] += by.segment<3>(row);
      g.platform_joint[i] += by.segment<3>(row + 3);
      l[i] += by[row + 6];
    }
    g.deviation += by[42];
    return kinematics::forward(g, l, X_BT).X_BT.translation();
  };
  const Eigen::Matrix3Xd rows = derivatives(tip, 43);
  Mat3 stated;
  ASSERT_TRUE(in_frame(hexapod_tip(known, found, {}), *table.frame, middle(table), known.X_WB)(X_BT, stated));
  expect_same(rows * stored.covariance * rows.transpose(), stated);
}

TEST(StoredParameters, OfAnArmMoveTheTipAsStated) {
  const auto drawn = machine::load_machine("arm");
  const Measurements table = measured(drawn, 30);
  const ChainCalibration found =
      calibrate_chain({drawn.chain().kinematics.chain, {}}, chain_samples(table, drawn));
  ASSERT_TRUE(found.ok()) << found.message;
  auto known = drawn;
  auto& kinematics = known.chain().kinematics;
  kinematics.design = kinematics.chain;
  kinematics.chain = absorb_zeros(found.parameters);
  const auto stored = stored_parameters(found, table, known);
  ASSERT_EQ(stored.covariance.rows(), 48);

  const Pose X_BT = some_pose(known);
  std::vector<double> axes(6);
  ASSERT_EQ(known.make_mechanism()->inverse(X_BT, {}, axes), kinematics::SolveStatus::ok);
  const auto tip = [&](const Eigen::VectorXd& by) -> Vec3 {
    kinematics::Chain chain = kinematics.chain;
    Eigen::Index row = 0;
    const auto next = [&] { return Vec3(by.segment<3>((row += 3) - 3)); };
    for (Pose* mount : {&chain.X_OT_zero, &chain.X_OS_zero}) {
      const Vec3 p = next(), w = next();
      *mount = make_pose(Mat3(exp_rotation(w) * mount->linear()), mount->translation() + p);
    }
    for (auto& axis : chain.axes) {
      axis.direction = (axis.direction + next()).normalized();
      axis.point += next();
    }
    return kinematics::forward(chain, axes).translation();
  };
  const Eigen::Matrix3Xd rows = derivatives(tip, 48);
  Mat3 stated;
  ASSERT_TRUE(in_frame(chain_tip(known, found), *table.frame, middle(table), known.X_WB)(X_BT, stated));
  expect_same(rows * stored.covariance * rows.transpose(), stated);
}

TEST(StoredParameters, DeviationAndPlayHaveRowsOfTheirOwn) {
  const auto drawn = machine::load_machine("hexapod");
  const Measurements table = BuiltMachine(drawn, 3).measured(drawn, 16);
  Calibration found;
  found.parameters = {drawn.hexapod().geometry, {50e-6, 51e-6, 52e-6, 53e-6, 54e-6, 55e-6}};
  const auto expect_diagonal = [&](const Unknowns& unknowns, double deviation, double last) {
    found.covariance = ParameterMatrix::Zero(unknowns.count(), unknowns.count());
    for (Eigen::Index k = 0; k < found.covariance.rows(); ++k)
      found.covariance(k, k) = static_cast<double>(k + 1);
    const auto stored = stored_parameters(found, unknowns, table, drawn);
    EXPECT_EQ(stored.covariance(41, 41), 42);
    EXPECT_EQ(stored.covariance(42, 42), deviation);
    EXPECT_EQ(stored.covariance.diagonal().tail<1>()[0], last);
    EXPECT_EQ(stored.play.has_value(), unknowns.play);
    return stored;
  };
  expect_diagonal({.deviation = true}, 43, 43);
  const auto stored = expect_diagonal({.play = true}, 0, 48);
  ASSERT_EQ(stored.covariance.rows(), 49);
  ASSERT_TRUE(stored.play);
  EXPECT_EQ((*stored.play)[5], 55e-6);
  found.covariance.resize(0, 0);
  EXPECT_EQ(stored_parameters(found, {}, table, drawn).covariance.size(), 0) << "of a plug-in";
}

/// Rounding and digits leave the matrix one that the file's reader takes.
TEST(StoredParameters, AreReadBack) {
  for (const char* name : {"hexapod", "arm"}) {
    const auto drawn = machine::load_machine(name);
    const Measurements table = measured(drawn, 30);
    auto known = drawn;
    known.calibration = {"test", "poses.csv", "0", 30, 1e-5};
    machine::CalibratedParameters written, read;
    if (known.is_chain()) {
      const auto found = calibrate_chain({drawn.chain().kinematics.chain, {}}, chain_samples(table, drawn));
      written = stored_parameters(found, table, known);
    } else {
      written = stored_parameters(make_maximum_likelihood()->calibrate(hexapod_problem(table, drawn)), {},
                                  table, known);
    }
    const TemporaryFolder folder;
    const auto path = folder / "machine.yaml";
    machine::write_calibrated(known, path, written);
    (void)machine::load_machine(path.string(), read);
    EXPECT_LT((read.covariance - written.covariance).norm(), 1e-9 * written.covariance.norm()) << name;
  }
}

}  // namespace
}  // namespace understudy::calibration
