#include "calibration/machine/calibrate_by_loads.h"

#include <cmath>

#include <gtest/gtest.h>

#include "calibration/machine/strut_sides.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "core/random_vector.h"

namespace understudy::calibration {
namespace {

constexpr double kPlay = 75e-6, kNoise = 5e-6, kTurnNoise = 0.1e-3;  // [m], [rad]

struct Lab {
  machine::MachineDescription machine = machine::load_machine("hexapod");
  kinematics::HexapodGeometry truth;
  Problem problem;
};

/// A machine off by 0.5 mm; gravity decides where its plays rest, and the drawing's loads where that is told.
Lab lab() {
  Lab lab;
  Random random(3, "calibrate by loads");
  const auto& drawn = lab.machine.hexapod().geometry;
  lab.truth = perturbed(drawn, 0.5e-3, random);
  lab.problem.nominal = {drawn, {}};
  lab.problem.nominal.play.fill(kPlay);
  const auto mechanism = lab.machine.make_mechanism();
  const auto poses = random_reachable_poses(*mechanism, reference_region(lab.machine.X_BT_home), 60, random);
  for (const Pose& X_BT : poses) {
    StrutLengths lengths, load;
    EXPECT_EQ(kinematics::inverse(drawn, X_BT, lengths), kinematics::SolveStatus::ok);
    PoseSample sample;
    sample.displacement = displacements(drawn, lengths);
    for (std::size_t i = 0; i < kStruts; ++i)
      lengths[i] = lab.truth.length_offset[i] + sample.displacement[i];
    auto stands = kinematics::forward(lab.truth, lengths, X_BT);
    EXPECT_TRUE(strut_loads(lab.machine, lab.truth, stands.X_BT, load));
    for (std::size_t i = 0; i < kStruts; ++i) lengths[i] -= std::copysign(0.5 * kPlay, load[i]);
    stands = kinematics::forward(lab.truth, lengths, X_BT);
    EXPECT_EQ(stands.status, kinematics::SolveStatus::ok);
    sample.X_BT = stands.X_BT;
    sample.X_BT.translation() += kNoise * normal_vec3(random);
    sample.X_BT.linear() = exp_rotation(kTurnNoise * normal_vec3(random)) * sample.X_BT.linear();
    sample.covariance.diagonal() << Vec3::Constant(kNoise * kNoise), Vec3::Constant(kTurnNoise * kTurnNoise);
    sample.approach = resting_sides(lab.machine, drawn, lab.machine.tolerances.manufactured, X_BT);
    lab.problem.samples.push_back(sample);
  }
  return lab;
}

int known(const Problem& problem) {
  int count = 0;
  for (const PoseSample& sample : problem.samples)
    for (const Approach side : sample.approach) count += side != Approach::unknown;
  return count;
}

TEST(CalibrateByLoads, TellsTheSidesThatTheDrawingLeavesOpen) {
  Lab lab = ::understudy::calibration::lab();
  const auto estimator = make_with_play();
  const int drawn = known(lab.problem);
  const Calibration once = estimator->calibrate(lab.problem);
  const Calibration found = calibrate_by_loads(lab.machine, *estimator, lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_GT(known(lab.problem), drawn + 20);
  for (const PoseSample& sample : lab.problem.samples) {
    StrutLengths load;
    ASSERT_TRUE(strut_loads(lab.machine, lab.truth, sample.X_BT, load));
    for (std::size_t i = 0; i < kStruts; ++i)
      EXPECT_GE(static_cast<double>(sample.approach[i]) * load[i], 0) << i;
  }
  // A side that is wrong by half of a play is a residual of 37 um beside 5 um of noise.
  EXPECT_LT(found.chi_square, 0.5 * once.chi_square);
}

TEST(CalibrateByLoads, LeavesAnEstimatorWithoutPlaysAsItIs) {
  Lab lab = ::understudy::calibration::lab();
  const auto estimator = make_maximum_likelihood();
  const int drawn = known(lab.problem);
  const Calibration once = estimator->calibrate(lab.problem);
  const Calibration found = calibrate_by_loads(lab.machine, *estimator, lab.problem);
  EXPECT_EQ(known(lab.problem), drawn);
  EXPECT_EQ(found.chi_square, once.chi_square);
}

}  // namespace
}  // namespace understudy::calibration
