// Plug-ins that calibrate open chains: what they are told, what they may answer, and that one finds the arm.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calibration/plugin/chain_exchange.h"
#include "core/units.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "studies/calibration/calibration_benchmark.h"

namespace understudy::rehearsal {
namespace {

using calibration::ChainParameters;
using calibration::ChainSample;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kExample =
    "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/screw_by_screw.py";

const machine::MachineDescription& arm() {
  static const machine::MachineDescription machine = machine::load_machine("arm");
  return machine;
}

ChainParameters nominal() { return {arm().chain().kinematics.chain, {}}; }

ChainParameters built() {
  const auto as_built = sim::make_as_built(arm(), "manufactured", 3);
  ChainParameters truth{as_built.chain, {}};
  truth.zero.assign(as_built.axis_zero.begin(),
                    as_built.axis_zero.begin() + static_cast<std::ptrdiff_t>(as_built.chain.axes.size()));
  return truth;
}

/// Without noise, axes within half of their ranges.
std::vector<ChainSample> samples(const ChainParameters& truth, std::size_t count, const char* purpose) {
  Random random(1, purpose);
  std::vector<ChainSample> all(count);
  for (ChainSample& sample : all) {
    for (const auto& axis : truth.chain.axes)
      sample.axes.push_back(0.5 * (axis.lower + axis.upper) +
                            0.25 * (axis.upper - axis.lower) * random.uniform(-1, 1));
    sample.X_ST = forward(truth, sample.axes);
    sample.covariance = calibration::kReferenceNoise.covariance();
  }
  return all;
}

Json told() { return Json::parse(chain_problem_json(nominal(), samples(built(), 2, "chain plug-in"))); }

std::string answered(const Json& answer) { return read_chain_answer(answer.dump(), nominal()).failure; }

Json nominal_answer() {
  const Json problem = told();
  return {{"schema", "understudy.chain-calibration-answer/1"},
          {"axes", problem["nominal"]["axes"]},
          {"tool", problem["nominal"]["tool"]},
          {"work", problem["nominal"]["work"]}};
}

// What a plug-in reads, sent back as an answer, is the machine that it was.
TEST(ChainPlugin, TheProblemTellsTheWholeMachine) {
  const ChainPluginAnswer same = read_chain_answer(nominal_answer().dump(), nominal());
  ASSERT_TRUE(same.ok) << same.failure;
  for (const ChainSample& sample : samples(nominal(), 5, "chain plug-in"))
    EXPECT_TRUE(forward(same.parameters, sample.axes).isApprox(sample.X_ST, 1e-12));
  const Json problem = told();
  EXPECT_EQ(problem["samples"].size(), 2u);
  EXPECT_EQ(problem["samples"][0]["readings_mm_rad"].size(), 6u);
  EXPECT_DOUBLE_EQ(problem["samples"][0]["covariance_mm_rad"][0][0].get<double>(), 4e-4);  // (20 um)^2
}

TEST(ChainPlugin, NonsenseIsAFailureThatSaysWhatIsWrong) {
  EXPECT_EQ(answered(nominal_answer()), "");
  const auto with = [](const char* path, const Json& value) {
    Json answer = nominal_answer();
    answer[Json::json_pointer(path)] = value;
    return answered(answer);
  };
  EXPECT_THAT(with("/schema", "understudy.calibration-answer/1"), HasSubstr("chain-calibration-answer/1"));
  EXPECT_THAT(with("/axes", Json::array()), HasSubstr("axes is not a list of 6"));
  EXPECT_THAT(with("/axes/2", 7), HasSubstr("axes[2] is not an object"));
  EXPECT_THAT(with("/axes/2/direction", {0, 0, 1.01}),
              HasSubstr("axes[2].direction has length 1.01, must be 1"));
  EXPECT_THAT(with("/axes/1/point_mm/0", 1e9),
              HasSubstr("axes[1].point_mm[0] is 1000000000 mm, beyond 10000 mm"));
  EXPECT_THAT(with("/axes/1/zero_mm_rad", 400), HasSubstr("beyond 10 rad"));
  EXPECT_THAT(with("/axes/1/zero_mm_rad", nullptr), HasSubstr("not a number"));
  EXPECT_THAT(with("/tool/quaternion_wxyz", {1, 1, 0, 0}), HasSubstr("tool.quaternion_wxyz has length 1.41"));
  EXPECT_THAT(with("/failure", "too few"), HasSubstr("says: too few"));
  EXPECT_THAT(read_chain_answer("hello", nominal()).failure, HasSubstr("not one JSON value"));
}

// Exact data: what is left are the derivatives' steps and the damping, far below a micrometre.
TEST(ChainPlugin, TheExampleFindsTheArmWithoutNoise) {
  const ChainParameters truth = built();
  double seconds = 0;
  const auto found =
      ask_chain_plugin(kExample, nominal(), samples(truth, 14, "chain plug-in"), {.time = 60}, seconds);
  ASSERT_TRUE(found.ok) << found.failure;
  for (const ChainSample& held_out : samples(truth, 20, "held out")) {
    const Vec3 p = held_out.X_ST.translation();
    EXPECT_GT((forward(nominal(), held_out.axes).translation() - p).norm(), 1e-4);
    EXPECT_LT((forward(found.parameters, held_out.axes).translation() - p).norm(), 1e-7);
  }
}

// The same likelihood: the same answer as ours within the noise, each problem solved by both.
TEST(ChainPlugin, EntersTheBenchmarkOfTheArm) {
  CalibrationBenchmarkRequest request;
  request.machine = "arm";
  request.trials = 1;
  request.poses = {14};
  request.disturbances = {Disturbance::none};
  request.plugins = {kExample, "echo '{}'"};
  request.plugin_limits.time = 60;
  request.estimators = {"chain"};
  const CalibrationBenchmark b = run_benchmark(request);
  ASSERT_EQ(b.entrants.size(), 3u);
  const auto& scores = b.conditions[0].scores;
  EXPECT_EQ(scores[1].failures, 0);
  EXPECT_NEAR(scores[1].median, scores[0].median, 0.02 * scores[0].median);
  ASSERT_EQ(scores[2].failures, 1);
  EXPECT_THAT(scores[2].reasons.begin()->first, HasSubstr("schema is null"));
}

}  // namespace
}  // namespace understudy::rehearsal
