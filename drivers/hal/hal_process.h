// Private to drivers/hal: HAL started in a folder of `understudy export hal`, and ended again.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "core/file/descriptor.h"
#include "drivers/hal/child_process.h"

namespace understudy::drivers {

/// Begins the name of a signal that every configuration of ours has; its fingerprint follows.
inline constexpr const char* kHalSignal = "understudy-";

class HalProcess {
 public:
  /// Waits until HAL has the signal `configuration`, `understudy-FINGERPRINT`. LinuxCNC's launcher may fail
  /// while an earlier HAL is ending or the computer is busy: it is then tried again. Throws InputError for a
  /// file that HAL refuses, MachineError where HAL runs already, is not installed or does not start.
  /// `linger` [s]: how long HAL goes on after this process was killed, so that its watchdog stops the
  /// machine.
  HalProcess(const std::string& folder, const std::string& configuration, double linger);
  ~HalProcess() { end(); }
  HalProcess(const HalProcess&) = delete;
  HalProcess& operator=(const HalProcess&) = delete;

  void end();

 private:
  enum class Start { loaded, refused, ended, stuck };

  void start(const std::string& configuration);
  void launch();
  void start_guard();
  Start loading(const std::string& configuration);
  bool is_transient(Start start) const;
  [[noreturn]] void refuse(Start start) const;
  std::string log_text() const;

  const std::string folder_;
  const double linger_;
  Descriptor log_;
  Descriptor life_;  ///< closes with us: the guard's sign that we have died
  std::unique_ptr<ChildProcess> halrun_;
  std::unique_ptr<ChildProcess> guard_;  ///< keeps HAL alive for `linger` after our death
};

inline constexpr std::chrono::milliseconds kAnswerPatience{5000};  ///< for one call of halcmd

/// Where HAL's programs find each other; once before any of them is called.
void set_hal_environment();

/// The configuration of ours that HAL runs, `understudy-FINGERPRINT`; empty: none.
std::string running_hal();

}  // namespace understudy::drivers
