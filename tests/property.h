// Statements that hold for every input, tried on inputs that RapidCheck makes. A failure prints the smallest
// input that it found and the RC_PARAMS with which it comes again:
//   RC_PARAMS="reproduce=..." PROGRAM --gtest_filter=NAME
// Without RC_PARAMS the seed is fixed, so that every run tries the same inputs. RC_PARAMS="seed=7" tries
// others, RC_PARAMS="max_success=100000" more of them. RC_ASSERT and RC_PRE evaluate both sides of && and ||:
// where the first side guards the second, put parentheses around the whole.
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <rapidcheck.h>
#include <rapidcheck/detail/Configuration.h>

#include "core/frames.h"

namespace understudy::property {

struct Trials {
  int cases = 100;
  int size = 100;  ///< of the largest containers
};

/// RapidCheck's own prints of every property that holds.
class SilentListener : public rc::detail::TestListener {
  void onTestCaseFinished(const rc::detail::CaseDescription& /*description*/) override {}
  void onShrinkTried(const rc::detail::CaseDescription& /*shrink*/, bool /*accepted*/) override {}
  void onTestFinished(const rc::detail::TestMetadata& /*name*/,
                      const rc::detail::TestResult& /*result*/) override {}
};

/// Fails the running test where `property`, a function of no or of generated arguments, fails for an input.
template <typename Property>
void check(const Trials& trials, Property&& property) {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  rc::detail::TestMetadata name;
  name.id = name.description = std::string(test.test_suite_name()) + "." + test.name();

  rc::detail::Configuration settings;
  settings.testParams.seed = 1;
  settings.testParams.maxSuccess = trials.cases;
  settings.testParams.maxSize = trials.size;
  if (const char* wanted = std::getenv("RC_PARAMS"))
    settings = rc::detail::configFromString(wanted, settings);

  SilentListener silent;
  const rc::detail::TestResult result =
      rc::detail::checkProperty(rc::detail::toProperty(std::forward<Property>(property)), name,
                                settings.testParams, silent, settings.reproduce);
  if (result.is<rc::detail::SuccessResult>()) return;
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  if (result.is<rc::detail::FailureResult>()) {
    rc::detail::Configuration again;
    again.reproduce.emplace(name.id, result.get<rc::detail::FailureResult>().reproduce);
    text << "\n\nThis input again:\nRC_PARAMS=\"" << rc::detail::configToMinimalString(again)
         << "\" PROGRAM --gtest_filter=" << name.id;
  }
  FAIL() << text.str();
}

/// Spread evenly over [low, high], either side of 0 as often; shrinks towards 0, or the end that is nearer.
inline rc::Gen<double> real(double low, double high) {
  constexpr int kSteps = 1 << 30;
  return rc::gen::map(rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, kSteps + 1)),
                      [low, high](int drawn) {
                        const double share = drawn / static_cast<double>(kSteps);
                        if (low >= 0) return low + share * (high - low);
                        if (high <= 0) return high - share * (high - low);
                        // Low bits say which side, so that both shrink to 0.
                        const bool below = drawn % 2 == 1;
                        return share * (below ? low : high);
                      });
}

/// As real(), by orders of magnitude: 0 < low < high. Shrinks towards `low`.
inline rc::Gen<double> magnitude(double low, double high) {
  return rc::gen::map(real(0, std::log(high / low)), [low](double power) { return low * std::exp(power); });
}

/// Every coordinate in [-size, size].
inline rc::Gen<Vec3> vector(double size) {
  return rc::gen::map(rc::gen::tuple(real(-size, size), real(-size, size), real(-size, size)),
                      [](const std::tuple<double, double, double>& v) {
                        return Vec3(std::get<0>(v), std::get<1>(v), std::get<2>(v));
                      });
}

/// In [low, high], all of them from the first case on; shrinks towards `low`.
inline rc::Gen<int> whole(int low, int high) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1));
}

}  // namespace understudy::property

namespace Eigen {
/// How counterexamples show vectors.
inline void showValue(const Vector3d& v, std::ostream& out) {
  out << "(" << v.x() << ", " << v.y() << ", " << v.z() << ")";
}
}  // namespace Eigen
