// What plug-ins are told of open chains, what they may answer, and that one finds the arm.
#include "calibration/plugin/exchange.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calibration/plugin/plugin_estimator.h"
#include "calibration/synthetic.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kExample =
    "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/screw_by_screw.py";

const machine::MachineDescription& arm() {
  static const machine::MachineDescription machine = machine::load_machine("arm");
  return machine;
}

ChainParameters nominal() { return {arm().chain().kinematics.chain, {}}; }

/// Off its drawing by 0.3 mm and 0.3 mrad.
ChainParameters built() {
  Random random(3, "built arm");
  Eigen::VectorXd by(static_cast<Eigen::Index>(chain_parameter_names(nominal().chain).size()));
  for (Eigen::Index k = 0; k < by.size(); ++k) by[k] = 0.3e-3 * random.normal();
  return moved(nominal(), by);
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
    sample.covariance = kReferenceNoise.covariance();
  }
  return all;
}

Json told() {
  return Json::parse(problem_json(ChainProblem{nominal(), samples(built(), 2, "chain plug-in")}));
}

std::string answered(const Json& answer) {
  ChainParameters parameters = nominal();
  return read_answer(answer.dump(), parameters);
}

std::string answered_text(const std::string& text) {
  ChainParameters parameters = nominal();
  return read_answer(text, parameters);
}

Json nominal_answer() {
  const Json problem = told();
  return {{"schema", "understudy.calibration-answer/2"},
          {"axes", problem["nominal"]["axes"]},
          {"tool", problem["nominal"]["tool"]},
          {"work", problem["nominal"]["work"]}};
}

// What a plug-in reads, sent back as an answer, is the machine that it was.
TEST(Exchange, TheProblemTellsTheWholeMachine) {
  ChainParameters same = nominal();
  ASSERT_EQ(read_answer(nominal_answer().dump(), same), "");
  for (const ChainSample& sample : samples(nominal(), 5, "chain plug-in"))
    EXPECT_TRUE(forward(same, sample.axes).isApprox(sample.X_ST, 1e-12));
  const Json problem = told();
  EXPECT_EQ(problem["samples"].size(), 2u);
  EXPECT_EQ(problem["samples"][0]["readings_mm_rad"].size(), 6u);
  EXPECT_DOUBLE_EQ(problem["samples"][0]["covariance_mm_rad"][0][0].get<double>(), 4e-4);  // (20 um)^2
}

TEST(Exchange, NonsenseIsAFailureThatSaysWhatIsWrong) {
  EXPECT_EQ(answered(nominal_answer()), "");
  const auto with = [](const char* path, const Json& value) {
    Json answer = nominal_answer();
    answer[Json::json_pointer(path)] = value;
    return answered(answer);
  };
  EXPECT_THAT(with("/schema", "understudy.calibration-answer/1"), HasSubstr("calibration-answer/2"));
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
  EXPECT_THAT(answered_text("hello"), HasSubstr("not one JSON value"));
}

// Exact data: what is left are the derivatives' steps and the damping, far below a micrometre.
TEST(Exchange, TheExampleFindsTheArmWithoutNoise) {
  const ChainParameters truth = built();
  const auto plugin = make_plugin_estimator(kExample, {.time = 60});
  const ChainCalibration found = plugin->calibrate_chain({nominal(), samples(truth, 14, "chain plug-in")});
  ASSERT_TRUE(found.ok()) << found.message;
  for (const ChainSample& held_out : samples(truth, 20, "held out")) {
    const Vec3 p = held_out.X_ST.translation();
    EXPECT_GT((forward(nominal(), held_out.axes).translation() - p).norm(), 1e-4);
    EXPECT_LT((forward(found.parameters, held_out.axes).translation() - p).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace understudy::calibration
