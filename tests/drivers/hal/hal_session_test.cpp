#include "drivers/hal/hal_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/drivers/hal/hal_machine.h"

namespace understudy::drivers {
namespace {

using testing::HasSubstr;

std::string refusal(const HalSettings& settings, const std::string& folder) {
  try {
    const HalSession session(settings, folder);
  } catch (const InputError& error) {
    return std::string("input: ") + error.what();
  } catch (const MachineError& error) {
    return std::string("machine: ") + error.what();
  }
  return "opened";
}

TEST(HalSession, RefusesAFolderWithoutAConfiguration) {
  const HalMachine hal;
  const std::string said = refusal(hal.settings(), "/nowhere");
  EXPECT_THAT(said,
              HasSubstr("input: hal:///nowhere: no machine.hal in it; write it by: understudy export hal"));
}

TEST(HalSession, RefusesAConfigurationOfOtherAxes) {
  const HalMachine hal;
  const HalSettings other = hal_settings(machine::load_machine("hexapod"));
  const std::string said = refusal(other, hal.folder());
  EXPECT_THAT(said, HasSubstr("input: "));
  EXPECT_THAT(said, HasSubstr("machine.hal: written for another machine, calibration or version"));
}

TEST(HalSession, SaysWhatToStartWhereNoHalRuns) {
  SKIP_WITHOUT_HAL();
  const HalMachine hal;
  EXPECT_THAT(refusal(hal.settings(), ""), HasSubstr("machine: hal://: HAL does not run"));
}

TEST(HalSession, RefusesASecondOneAndAHalThatRunsAlready) {
  SKIP_WITHOUT_HAL();
  const HalMachine hal;
  {
    const HalSession first(hal.settings(), hal.folder());
    EXPECT_THAT(refusal(hal.settings(), hal.folder()), HasSubstr("machine: HAL is held by another run"));
    EXPECT_THAT(refusal(hal.settings(), ""), HasSubstr("machine: HAL is held by another run"));
  }
  EXPECT_THAT(RunningHal::command({"show", "sig", "machine-on"}), testing::Not(HasSubstr("machine-on")))
      << "HAL ends with the session that started it";
  const RunningHal running(hal);
  EXPECT_THAT(refusal(hal.settings(), hal.folder()), HasSubstr("machine: HAL runs already"));
  EXPECT_THAT(refusal(hal_settings(machine::load_machine("arm")), ""),
              HasSubstr("input: hal://: HAL runs with the configuration understudy-"));
  RunningHal::command({"setp", "stepgen.1.position-scale", "80"});
  EXPECT_THAT(refusal(hal.settings(), ""),
              HasSubstr("input: hal://: axis l2 has 80 steps per unit in HAL, 125.984"));
}

TEST(HalSession, NamesWhatHalSaysOfABrokenFile) {
  SKIP_WITHOUT_HAL();
  const HalMachine hal;
  std::ofstream(hal.folder() + "/pins.hal") << "net emergency-stop-ok <= parport.0.pin-10-in\n";
  EXPECT_THAT(refusal(hal.settings(), hal.folder()),
              HasSubstr("input: hal://" + hal.folder() + ": HAL refuses pins.hal:1: "));
}

}  // namespace
}  // namespace understudy::drivers
