// The hexapod on LinuxCNC's HAL in simulation, for tests. They skip where linuxcnc-uspace is absent.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/hal/child_process.h"
#include "drivers/hal/hal_files.h"
#include "drivers/hal/hal_port.h"
#include "drivers/hal/hal_process.h"
#include "machine/description.h"

#define SKIP_WITHOUT_HAL() \
  if (!understudy::drivers::has_hal()) GTEST_SKIP() << "halrun is not installed (linuxcnc-uspace)"

namespace understudy::drivers {

inline bool has_hal() { return std::filesystem::exists("/usr/bin/halrun"); }

/// A machine file and the configuration exported from it, in a folder of the test's own. Full steps only: a
/// base thread without a real-time kernel makes ten thousand a second.
class HalMachine {
 public:
  /// `more` goes to the end of the machine file.
  explicit HalMachine(const HalOptions& options = trial_options(), const std::string& more = "") {
    prefer_this_thread();  // it is the controller: late only when the computer is
    folder_ = std::filesystem::path(testing::TempDir()) / ("understudy-hal-" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::ifstream original(std::filesystem::path(UNDERSTUDY_SOURCE_DIR) / "models/hexapod/machine.yaml");
    std::stringstream text;
    text << original.rdbuf();
    std::string file = text.str();
    const std::string fine = "microsteps: 16";
    file.replace(file.find(fine), fine.size(), "microsteps: 1");
    std::ofstream(folder_ / "machine.yaml") << file << more;
    machine_ = machine::load_machine((folder_ / "machine.yaml").string());
    settings_ = hal_settings(machine_, options);
    for (const HalFile& f : hal_files(settings_)) std::ofstream(folder_ / f.name) << f.text;
  }
  ~HalMachine() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  HalMachine(const HalMachine&) = delete;
  HalMachine& operator=(const HalMachine&) = delete;

  /// A loaded computer without a real-time kernel: threads drift apart.
  static HalOptions trial_options() {
    HalOptions options;
    options.base_period_us = 100;
    options.following = 2;
    options.watchdog = 0.5;
    return options;
  }

  const machine::MachineDescription& machine() const { return machine_; }
  const HalSettings& settings() const { return settings_; }
  std::string folder() const { return folder_.string(); }
  /// [m], of an axis: one step of its drive.
  double step(int axis = 0) const {
    return settings_.axes[static_cast<std::size_t>(axis)].si(
        1 / settings_.axes[static_cast<std::size_t>(axis)].scale);
  }
  std::unique_ptr<HalPort> open(double lead = kLead) const {
    HalPortOptions options;
    options.folder = folder();
    options.lead = lead;
    return std::make_unique<HalPort>(machine_, options);
  }
  std::unique_ptr<HalPort> attach(double lead = kLead) const {
    HalPortOptions options;
    options.lead = lead;
    return std::make_unique<HalPort>(machine_, options);
  }

  static constexpr double kLead = 1.2;  // [s]: how late this process may be on a loaded computer

 private:
  std::filesystem::path folder_;
  machine::MachineDescription machine_;
  HalSettings settings_;
};

/// HAL started by itself, as an operator does; ends with the object.
class RunningHal {
 public:
  explicit RunningHal(const HalMachine& hal)
      : hal_(hal.folder(), kHalSignal + hal.settings().fingerprint, 0) {}

  static std::string command(std::vector<std::string> words) {
    words.insert(words.begin(), {"halcmd", "-s"});
    return answer_of(words, std::chrono::seconds(10));
  }

 private:
  HalProcess hal_;
};

/// What a further sampler of the configuration saw, from when HAL was started: 1 the setpoints as received,
/// 2 the steps made (docs/linuxcnc.md).
class HalRecorder {
 public:
  HalRecorder(const HalMachine& hal, int channel)
      : file_(hal.folder() + "/channel-" + std::to_string(channel) + ".txt"),
        sampler_({"stdbuf", "-oL", "halsampler", "-c", std::to_string(channel), file_}, "", {}, true) {}
  std::vector<std::vector<double>> samples() {
    sampler_.end(std::chrono::milliseconds(0));
    return so_far();
  }
  /// Whole lines of the file while it grows; only those that have come since the last call are read.
  const std::vector<std::vector<double>>& so_far() {
    std::ifstream in(file_);
    in.seekg(read_);
    for (std::string line; std::getline(in, line) && !in.eof(); read_ = in.tellg()) {
      EXPECT_NE(line, "overrun") << "the recorder was late";
      if (line == "overrun") continue;
      std::istringstream words(line);
      samples_.emplace_back(std::istream_iterator<double>(words), std::istream_iterator<double>());
    }
    return samples_;
  }

 private:
  std::string file_;
  ChildProcess sampler_;
  std::streamoff read_ = 0;
  std::vector<std::vector<double>> samples_;
};

}  // namespace understudy::drivers
