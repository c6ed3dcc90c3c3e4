// LinuxCNC with the configuration of the hexapod, headless, for tests. They skip where linuxcnc-uspace is
// absent.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "drivers/gcode/byte_link.h"
#include "drivers/hal/child_process.h"
#include "drivers/hal/linuxcnc_files.h"
#include "machine/description.h"

#define SKIP_WITHOUT_LINUXCNC()                         \
  if (!std::filesystem::exists("/usr/bin/linuxcncrsh")) \
  GTEST_SKIP() << "linuxcncrsh is not installed (linuxcnc-uspace)"

namespace understudy::drivers {

class RunningLinuxcnc {
 public:
  explicit RunningLinuxcnc(const std::string& machine = "hexapod")
      : machine_(machine::load_machine(machine)) {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("understudy-linuxcnc-" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    HalOptions options;
    options.following = 2;  // a loaded computer without a real-time kernel
    for (const HalFile& f : linuxcnc_files(machine_, options)) std::ofstream(folder_ / f.name) << f.text;
    ::setenv("RTAPI_UID", "65534", 0);
    ::setenv("RTAPI_FIFO_PATH", ("/tmp/understudy-rtapi-" + std::to_string(::getuid())).c_str(), 0);
    std::filesystem::permissions(folder_, std::filesystem::perms::all);
    process_ = std::make_unique<ChildProcess>(std::vector<std::string>{"linuxcnc", "-r", "machine.ini"},
                                              folder_.string(), ChildStreams{}, false);
    for (int i = 0; i < 300 && process_->running(); ++i) {
      try {
        open_tcp_link(parse_port_uri(uri()));
        return;
      } catch (const MachineError&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    }
    ADD_FAILURE() << "LinuxCNC does not start";
  }
  ~RunningLinuxcnc() {
    try {
      const auto link = open_tcp_link(parse_port_uri(uri()));
      static_cast<void>(link->send("hello EMC test 1.0\r\nset enable EMCTOO\r\nshutdown\r\n"));
      link->wait(link->now() + 1);
    } catch (const MachineError&) {  // it has ended
    }
    process_->end(std::chrono::seconds(15));
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  RunningLinuxcnc(const RunningLinuxcnc&) = delete;
  RunningLinuxcnc& operator=(const RunningLinuxcnc&) = delete;

  const machine::MachineDescription& machine() const { return machine_; }
  std::string uri(const std::string& options = "") const {
    return "tcp://127.0.0.1:5007?family=linuxcnc" + options;
  }
  /// [m], of the drives: what HAL has behind LinuxCNC's kinematics.
  static std::vector<double> strut_lengths() {
    std::vector<double> lengths;
    for (int i = 1; i <= 6; ++i)
      lengths.push_back(1e-3 * std::atof(hal({"gets", "l" + std::to_string(i) + "-feedback"}).c_str()));
    return lengths;
  }
  static std::string hal(std::vector<std::string> words) {
    words.insert(words.begin(), {"halcmd", "-s"});
    return answer_of(words, std::chrono::seconds(10));
  }

 private:
  machine::MachineDescription machine_;
  std::filesystem::path folder_;
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace understudy::drivers
