// A plug-in as an estimator: nothing but a machine or a reason comes out.
#include "calibration/plugin/plugin_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "machine/description.h"
#include "tests/calibration/plugin/script.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

Problem problem() {
  const auto machine = machine::load_machine("hexapod");
  const auto mechanism = machine.make_mechanism();
  Problem p{{machine.hexapod().geometry, {}}, {}};
  Random random(1, "plugin test");
  HexapodParameters truth = p.nominal;
  truth.geometry = perturbed(p.nominal.geometry, 0.5e-3, random);
  for (const Pose& X : random_reachable_poses(*mechanism, reference_region(machine.X_BT_home), 12, random)) {
    PoseSample sample;
    if (true_sample(truth, p.nominal.geometry, X, kReferenceNoise, {}, sample)) p.samples.push_back(sample);
  }
  return p;
}

Calibration ask(const std::string& script) {
  const Calibration found =
      make_plugin_estimator(Script(script).command(), {.time = 5})->calibrate(problem());
  EXPECT_TRUE(found.ok() || found.status == Status::no_answer);
  return found;
}

TEST(PluginEstimator, NonsenseIsAFailureThatSaysWhatIsWrong) {
  const std::string answer = R"("schema": "understudy.calibration-answer/2")";
  EXPECT_THAT(ask("echo hello").message, HasSubstr("not one JSON value: \"hello\""));
  EXPECT_THAT(ask("echo '{}' >&2").message,
              ::testing::AllOf(HasSubstr("nothing to standard output"), HasSubstr("{}")));
  EXPECT_THAT(ask("echo '{}'").message, HasSubstr("schema is null"));
  EXPECT_THAT(ask("echo '[]'").message, HasSubstr("not an object"));
  EXPECT_THAT(ask("echo '{\"schema\": \"understudy.calibration-answer/1\"}'").message, HasSubstr("answer/1"));
  EXPECT_THAT(ask("echo '{" + answer + "}'").message, HasSubstr("has no base_joints_mm"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": [[1,2,3]]}'").message, HasSubstr("list of 6"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"failure\": \"too few\"}'").message, HasSubstr("says: too few"));
  EXPECT_THAT(ask("cat").message, HasSubstr("schema is \"understudy.calibration-problem/2\""));
  const std::string rows = "[[1,2,3],[1,2,3],[1,2,3],[1,2,3],[1,2,3],[1,2,";
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": " + rows + "1e300]]}'").message,
              HasSubstr("beyond"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": " + rows + "NaN]]}'").message,
              HasSubstr("not one JSON"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": " + rows + "null]]}'").message,
              HasSubstr("not a number"));
}

// The example solves exact data exactly; 1e-6 m: its steps end at 1e-9 mm, times a condition near 1000.
TEST(PluginEstimator, TheExampleFindsTheMachineWithoutNoise) {
  const auto plugin = make_plugin_estimator("python3 " UNDERSTUDY_SOURCE_DIR
                                            "/examples/calibration-plugin/strut_by_strut.py");
  const Problem exact = problem();
  const Calibration found = plugin->calibrate(exact);
  ASSERT_TRUE(found.ok()) << found.message;
  for (const Twist& residual : found.residuals) EXPECT_LT(residual.head<3>().norm(), 1e-9);
  EXPECT_LT(found.chi_square, 1e-6);
  EXPECT_EQ(found.degrees_of_freedom, 6 * 12 - 42);
  EXPECT_EQ(found.covariance.size(), 0);
  Random random(1, "plugin test");
  const auto truth = perturbed(exact.nominal.geometry, 0.5e-3, random);
  for (std::size_t i = 0; i < kStruts; ++i)
    EXPECT_LT((truth.base_joint[i] - found.parameters.geometry.base_joint[i]).norm(), 1e-6);
  Problem few = exact;
  few.samples.resize(5);
  const Calibration refused = plugin->calibrate(few);
  EXPECT_EQ(refused.status, Status::no_answer);
  EXPECT_THAT(refused.message, HasSubstr("fewer than 7 poses"));
}

TEST(PluginEstimator, AMachineThatCannotReachThePosesIsNoAnswer) {
  const std::string far = "[[9000,0,0],[9000,0,0],[9000,0,0],[9000,0,0],[9000,0,0],[9000,0,0]]";
  const Calibration found =
      ask("echo '{\"schema\": \"understudy.calibration-answer/2\", \"base_joints_mm\": " + far +
          ", \"platform_joints_mm\": [[0,0,1],[0,0,1],[0,0,1],[0,0,1],[0,0,1],[0,0,1]], "
          "\"length_offsets_mm\": [1,1,1,1,1,1]}'");
  EXPECT_THAT(found.message, HasSubstr("cannot reach pose 1"));
  EXPECT_EQ(found.pose, 0u);
}

}  // namespace
}  // namespace understudy::calibration
