// Bytes as a plug-in's answer, of a hexapod and of a chain. Its reader throws nothing at all.
#include <nlohmann/json.hpp>

#include "calibration/plugin/exchange.h"
#include "machine/description.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

using calibration::ChainParameters;
using calibration::HexapodParameters;

void check(const HexapodParameters& machine) {
  for (std::size_t i = 0; i < calibration::kStruts; ++i) {
    require_finite(machine.geometry.base_joint[i], "base joint");
    require_finite(machine.geometry.platform_joint[i], "platform joint");
    require_finite(machine.geometry.length_offset[i], "length offset");
  }
  require_finite(machine.geometry.deviation, "deviation");
}

void check(const ChainParameters& machine) {
  for (const auto& axis : machine.chain.axes) {
    require_finite(axis.point, "point of an axis");
    require_near(axis.direction.norm(), 1, 1e-9, 0, "length of an axis' direction");
  }
  require_finite(machine.zero, "zero of an axis");
  require_finite(machine.chain.X_OT_zero, "tool");
  require_finite(machine.chain.X_OS_zero, "work");
}

/// The machine of a problem, sent back as the answer.
std::string echo(const std::string& problem) {
  nlohmann::json answer = nlohmann::json::parse(problem).at("nominal");
  answer["schema"] = "understudy.calibration-answer/2";
  return answer.dump();
}

double difference(const HexapodParameters& a, const HexapodParameters& b) {
  double largest = std::abs(a.geometry.deviation - b.geometry.deviation);
  for (std::size_t i = 0; i < calibration::kStruts; ++i)
    largest = std::max({largest, (a.geometry.base_joint[i] - b.geometry.base_joint[i]).norm(),
                        std::abs(a.geometry.length_offset[i] - b.geometry.length_offset[i])});
  return largest;
}

double difference(const ChainParameters& a, const ChainParameters& b) {
  double largest = (a.chain.X_OT_zero.translation() - b.chain.X_OT_zero.translation()).norm();
  for (std::size_t i = 0; i < a.chain.axes.size(); ++i) {
    largest = std::max(largest, (a.chain.axes[i].direction - b.chain.axes[i].direction).norm());
    if (a.chain.axes[i].angle)
      largest = std::max(largest, (a.chain.axes[i].point - b.chain.axes[i].point).norm());
  }
  return largest;
}

template <typename Problem, typename Parameters>
void check_answer(const std::string& text, const Parameters& nominal) {
  Parameters told = nominal;
  const double begin = processor_time();
  const std::string wrong = calibration::read_answer(text, told);
  check_time(processor_time() - begin, text.size());
  check(told);
  if (!wrong.empty()) {
    require(difference(told, nominal) == 0,
            "an answer that was refused has changed the parameters: " + wrong);
    require(wrong.find('\n') == std::string::npos, "a refusal of more than one line: " + wrong);
    return;
  }
  Problem problem;
  problem.nominal = told;
  Parameters again = nominal;
  const std::string refusal = calibration::read_answer(echo(calibration::problem_json(problem)), again);
  require(refusal.empty(), "an answer that was accepted is refused when it is sent back: " + refusal);
  require(difference(again, told) < 1e-9, "an answer that was sent back came as another");
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const calibration::HexapodParameters hexapod{machine::load_machine("hexapod").hexapod().geometry,
                                                      {}};
  static const calibration::ChainParameters chain{machine::load_machine("five-axis").chain().kinematics.chain,
                                                  {}};
  const std::string text(fuzz::text_of(data, size));
  fuzz::check_answer<calibration::Problem>(text, hexapod);
  fuzz::check_answer<calibration::ChainProblem>(text, chain);
  return 0;
}
