#include "drivers/hal/hal_files.h"

#include <map>
#include <regex>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/hal/hal_machine.h"
#include "tests/temporary_folder.h"

namespace understudy::drivers {
namespace {

const std::string kWithEncoders = "hexapod{load_encoders.count_um: 0.5}";

std::string file_named(const std::vector<HalFile>& files, const std::string& name) {
  for (const HalFile& f : files)
    if (f.name == name) return f.text;
  ADD_FAILURE() << name;
  return {};
}

int matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  return static_cast<int>(std::distance(std::sregex_iterator(text.begin(), text.end(), expression), {}));
}

/// Every pin of the streamer and of the samplers is on one signal, for each shipped machine.
TEST(HalFiles, ConnectEveryColumnOnce) {
  std::vector<std::string> names = machine::machine_names();
  names.push_back(kWithEncoders);
  for (const std::string& name : names) {
    const HalSettings s = hal_settings(machine::load_machine(name));
    const std::string text = file_named(hal_files(s), "machine.hal");
    const auto check = [&](const std::string& pin, std::size_t columns) {
      for (std::size_t i = 0; i < columns; ++i)
        EXPECT_EQ(matches(text, pin + "\\.pin\\." + std::to_string(i) + "\\b"), 1)
            << name << " " << pin << " " << i;
      EXPECT_EQ(matches(text, pin + "\\.pin\\." + std::to_string(columns) + "\\b"), 0) << name << " " << pin;
    };
    const std::size_t n = s.axes.size();
    check("streamer\\.0", stream_columns(s).size());
    check("sampler\\.0", sample_columns(s).size());
    check("sampler\\.1", n + 2);
    check("sampler\\.3", n + 1);
    EXPECT_LE(sample_columns(s).size(), 21U) << "HAL's streams have no more columns";
  }
}

TEST(HalFiles, SayWhatIsAssumedAndWhatAMachineChanges) {
  const auto files = hal_files(hal_settings(machine::load_machine("hexapod")));
  EXPECT_THAT(file_named(files, "steps.hal"),
              testing::HasSubstr("setp stepgen.6.position-scale 415  # assumed"));
  EXPECT_EQ(matches(file_named(files, "steps.hal"), "assumed"), 1);
  EXPECT_THAT(file_named(files, "README.md"), testing::HasSubstr("| `filament` [mm] | 415 (**assumed**)"));
  EXPECT_THAT(file_named(files, "pins.hal"), testing::HasSubstr("emergency-stop-ok"));
}

TEST(HalFiles, HaveAPinForEachEncoderBehindThePlay) {
  const auto files = hal_files(hal_settings(machine::load_machine(kWithEncoders)));
  const std::string pins = file_named(files, "pins.hal"), machine = file_named(files, "machine.hal");
  for (int i = 1; i <= 6; ++i) {
    const std::string signal = "l" + std::to_string(i) + "-load";
    EXPECT_EQ(matches(pins, "\nnet " + signal + " <= "), 1) << signal;
    EXPECT_EQ(matches(machine, "\nnet " + signal + " => load\\.l" + std::to_string(i) + "\\.fb-in"), 1)
        << signal;
  }
  EXPECT_THAT(file_named(files, "README.md"), testing::HasSubstr("Counts a unit: `l1` 2000, `l2` 2000"));
  for (const HalFile& f : hal_files(hal_settings(machine::load_machine("hexapod"))))
    EXPECT_EQ(f.text.find("-load"), std::string::npos) << f.name;
}

/// HAL itself loads what is written, and its threads run.
void expect_loads(const std::string& name) {
  const HalSettings s = hal_settings(machine::load_machine(name));
  const TemporaryFolder folder;
  for (const HalFile& f : hal_files(s)) std::ofstream(folder / f.name) << f.text;
  set_hal_environment();
  const std::string said =
      answer_of({"sh", "-c",
                 "cd '" + folder.path().string() +
                     "' && echo 'getp sampler.0.curr-depth\ngetp sampler.3.curr-depth' | (sleep 0.3; cat) | "
                     "halrun -I -f machine.hal 2>&1"},
                std::chrono::seconds(60));
  EXPECT_EQ(said.find("rror"), std::string::npos) << name << ": " << said;
  EXPECT_EQ(said.find("machine.hal:"), std::string::npos) << name << ": " << said;
  std::vector<long> counts;
  const std::regex number("(^|\n|> )([0-9]+)\\s*(?=\n)");
  for (std::sregex_iterator it(said.begin(), said.end(), number), end; it != end; ++it)
    counts.push_back(std::stol((*it)[2]));
  ASSERT_GE(counts.size(), 2U) << name << ": " << said;
  EXPECT_GT(counts[0], 0) << name;
  EXPECT_GT(counts[1], 0) << name;
}

TEST(HalFiles, AreLoadedByHal) {
  SKIP_WITHOUT_HAL();
  for (const std::string& name : {std::string("arm-positioner"), std::string("five-axis"), kWithEncoders})
    expect_loads(name);
}

TEST(SlowHalFiles, AreLoadedByHalForEveryMachine) {
  SKIP_WITHOUT_HAL();
  for (const std::string& name : machine::machine_names()) expect_loads(name);
}

}  // namespace
}  // namespace understudy::drivers
