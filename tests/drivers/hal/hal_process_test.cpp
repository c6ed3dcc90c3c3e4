#include "drivers/hal/hal_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/drivers/hal/hal_machine.h"

namespace understudy::drivers {
namespace {

using testing::HasSubstr;

std::string start(const HalMachine& hal) {
  try {
    const HalProcess process(hal.folder(), kHalSignal + hal.settings().fingerprint, 0);
    return running_hal();
  } catch (const MachineError& error) {
    return std::string("machine: ") + error.what();
  }
}

/// HAL as LinuxCNC runs it: without a configuration of ours.
class OtherHal {
 public:
  OtherHal() : halrun_({"halrun", "-I"}, "", piped(), false) {
    constexpr std::string_view kThreads = "loadrt threads name1=other period1=1000000\n";
    EXPECT_EQ(::write(halrun_.input.get(), kThreads.data(), kThreads.size()),
              static_cast<ssize_t>(kThreads.size()));
    for (int i = 0; i < 200; ++i) {
      if (RunningHal::command({"show", "thread"}).find("other") != std::string::npos) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ADD_FAILURE() << "HAL does not start";
  }
  ~OtherHal() { end(); }
  OtherHal(const OtherHal&) = delete;
  OtherHal& operator=(const OtherHal&) = delete;
  void end() { halrun_.end(std::chrono::seconds(10)); }

 private:
  static ChildStreams piped() {
    ChildStreams streams;
    streams.input = true;
    return streams;
  }
  ChildProcess halrun_;
};

TEST(HalProcess, StartsOnceAHalThatIsEndingIsGone) {
  SKIP_WITHOUT_HAL();
  set_hal_environment();
  const HalMachine hal;
  OtherHal other;
  std::thread ends([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    other.end();
  });
  EXPECT_EQ(start(hal), kHalSignal + hal.settings().fingerprint);
  ends.join();
}

TEST(ExtendedHalProcess, SaysThatAnotherProgramUsesHal) {
  SKIP_WITHOUT_HAL();
  set_hal_environment();
  const HalMachine hal;
  const OtherHal other;
  EXPECT_THAT(start(hal), HasSubstr("machine: HAL runs already, with a configuration of another program"));
}

}  // namespace
}  // namespace understudy::drivers
