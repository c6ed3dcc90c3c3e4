// Machines drawn from what a calibration leaves open.
#include "sim/as_built/calibrated_draw.h"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/random.h"
#include "machine/file/calibration_section.h"
#include "sim/as_built/as_built_file.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kMachines = 1000;
constexpr Eigen::Index kRank = 12;

/// Calibrated parameters that are known but for `kRank` combinations of them.
struct Open {
  machine::MachineDescription machine;
  Eigen::MatrixXd root;
  machine::CalibratedParameters parameters;

  explicit Open(const char* name) : machine(machine::load_machine(name)) {
    if (machine.is_chain()) machine.chain().kinematics.design = machine.chain().kinematics.chain;
    machine.calibration = {"maximum_likelihood", "poses.csv", std::string(64, '0'), 24, 17.5e-6};
    Random random(2, "open parameters");
    root.resize(machine::calibrated_units(machine, false).size(), kRank);
    for (double& value : root.reshaped()) value = 10e-6 * random.normal();
    parameters.covariance = root * root.transpose();
  }
};

Eigen::VectorXd hexapod_errors(const machine::MachineDescription& machine, const AsBuilt& built) {
  Eigen::VectorXd errors(43);
  const auto& should = machine.hexapod().geometry;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    errors.segment<7>(7 * static_cast<Eigen::Index>(i)) << built.hexapod.base_joint[i] - should.base_joint[i],
        built.hexapod.platform_joint[i] - should.platform_joint[i],
        built.hexapod.length_offset[i] - should.length_offset[i];
  errors[42] = built.hexapod.deviation - should.deviation;
  return errors;
}

Eigen::VectorXd chain_errors(const machine::MachineDescription& machine, const AsBuilt& built) {
  const kinematics::Chain& should = machine.chain().kinematics.chain;
  Eigen::VectorXd errors(machine::calibrated_units(machine, false).size());
  Eigen::Index row = 0;
  const auto add = [&](const Vec3& v) {
    errors.segment<3>(row) = v;
    row += 3;
  };
  for (const auto mount : {&kinematics::Chain::X_OT_zero, &kinematics::Chain::X_OS_zero}) {
    const Pose &is = built.chain.*mount, &was = should.*mount;
    add(is.translation() - was.translation());
    add(log_rotation(is.linear() * was.linear().transpose()));
  }
  for (std::size_t i = 0; i < should.axes.size(); ++i) {
    add(built.chain.axes[i].direction - should.axes[i].direction);
    if (should.axes[i].angle) add(built.chain.axes[i].point - should.axes[i].point);
  }
  return errors;
}

TEST(CalibratedDraw, AHexapodSpreadsAsTheCovarianceStates) {
  const Open open("hexapod");
  Random random(3, "directions");
  Eigen::MatrixXd directions(43, 8);
  for (double& value : directions.reshaped()) value = random.normal();
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(8);
  // Without the rounding of what is known exactly.
  const Eigen::MatrixXd closed = Eigen::MatrixXd::Identity(43, 43) -
                                 open.root * open.root.completeOrthogonalDecomposition().pseudoInverse();
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    const auto errors = hexapod_errors(open.machine, draw_calibrated(open.machine, open.parameters, seed));
    squares += (directions.transpose() * errors).cwiseAbs2();
    ASSERT_LT((closed * errors).norm(), 1e-11) << "a known combination moved, seed " << seed;
  }
  for (Eigen::Index k = 0; k < 8; ++k) {
    const double stated = directions.col(k).dot(open.parameters.covariance * directions.col(k));
    // The standard error of a variance over n draws is sqrt(2 / n) of it; four of them.
    EXPECT_NEAR(squares[k] / kMachines / stated, 1, 4 * std::sqrt(2.0 / kMachines)) << "direction " << k;
  }
}

TEST(CalibratedDraw, AnArmSpreadsAsTheCovarianceStates) {
  const Open open("arm");
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(open.root.rows());
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed)
    squares += chain_errors(open.machine, draw_calibrated(open.machine, open.parameters, seed)).cwiseAbs2();
  const auto& axes = open.machine.chain().kinematics.chain.axes;
  for (Eigen::Index k = 0; k < squares.size(); ++k) {
    const Eigen::Index of_axis = k - 12, axis = of_axis / 6, coordinate = of_axis % 6;
    // Along itself a direction stays of unit length, whatever the covariance has there.
    if (of_axis >= 0 && coordinate < 3 &&
        std::abs(axes[static_cast<std::size_t>(axis)].direction[coordinate]) > 1e-9)
      continue;
    EXPECT_NEAR(squares[k] / kMachines / open.parameters.covariance(k, k), 1, 4 * std::sqrt(2.0 / kMachines))
        << "number " << k + 1;
  }
}

TEST(CalibratedDraw, ASeedIsAMachine) {
  const Open open("hexapod");
  const auto text = [&](std::uint64_t seed) {
    return write_as_built(draw_calibrated(open.machine, open.parameters, seed));
  };
  EXPECT_EQ(text(7), text(7));
  EXPECT_NE(text(7), text(8));
}

TEST(CalibratedDraw, PlayThatWasFoundTakesThePlaceOfTheDescribedOne) {
  Open open("hexapod");
  open.parameters = {{{50e-6, 60e-6, 70e-6, 80e-6, 90e-6, -1e-6}}, Eigen::MatrixXd::Zero(49, 49)};
  const AsBuilt built = draw_calibrated(open.machine, open.parameters, 1);
  const machine::Play& described = open.machine.hexapod().play;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    const double found = std::max(0.0, (*open.parameters.play)[i]);
    EXPECT_NEAR(built.nut_play[i] + built.ball_play[i], found, 1e-18);
    EXPECT_NEAR(built.nut_play[i] * described.ball_joint, built.ball_play[i] * described.screw_nut, 1e-18);
  }
}

class CalibratedFile : public testing::Test {
 protected:
  machine::MachineDescription written(const machine::MachineDescription& machine,
                                      const machine::CalibratedParameters& parameters) {
    machine::write_calibrated(machine, path_, parameters);
    return machine::load_machine(path_.string());
  }
  static std::string error_of(const machine::MachineDescription& machine) {
    try {
      make_as_built(machine, "calibrated", 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "machine.yaml";
};

TEST_F(CalibratedFile, IsDrawnFromByItsWordAndByDefault) {
  const Open open("hexapod");
  const auto machine = written(open.machine, open.parameters);
  EXPECT_EQ(default_as_built(machine), "calibrated");
  EXPECT_EQ(default_as_built(machine::load_machine("hexapod")), "sampled");
  const AsBuilt built = make_as_built(machine, default_as_built(machine), 9);
  EXPECT_EQ(built.source, "calibrated");
  EXPECT_EQ(built.seed, 9U);
  // The file's digits: a nanometre, and ten of the covariance.
  EXPECT_LT((hexapod_errors(machine, built) -
             hexapod_errors(open.machine, draw_calibrated(open.machine, open.parameters, 9)))
                .cwiseAbs()
                .maxCoeff(),
            2e-9);
}

TEST_F(CalibratedFile, AnArmThatWasDrawnIsWrittenWithItsMounts) {
  const Open open("arm");
  const auto machine = written(open.machine, open.parameters);
  const AsBuilt built = make_as_built(machine, "calibrated", 3);
  const auto truth = path_.string() + ".built.yaml";
  write_file(truth, write_as_built(built));
  const AsBuilt back = make_as_built(machine::load_machine("arm"), truth, 1);
  std::filesystem::remove(truth);
  EXPECT_LT((chain_errors(machine, back) - chain_errors(machine, built)).cwiseAbs().maxCoeff(), 2e-15);
}

TEST_F(CalibratedFile, WithoutACalibrationOrItsCovarianceSaysWhatToDo) {
  EXPECT_THAT(error_of(machine::load_machine("hexapod")),
              AllOf(HasSubstr("machine.yaml"), HasSubstr("no section calibration"),
                    HasSubstr("understudy calibrate"), HasSubstr("manufactured")));
  Open open("hexapod");
  open.machine.calibration->estimator = "plug-in: ./mine.py";
  EXPECT_THAT(error_of(written(open.machine, {})),
              AllOf(HasSubstr("/machine.yaml"), HasSubstr("by plug-in: ./mine.py, has no covariance"),
                    HasSubstr("manufactured")));
}

}  // namespace
}  // namespace understudy::sim
