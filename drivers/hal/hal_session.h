// Private to drivers/hal: HAL's processes, started or taken as they run, and the two streams to and from it.
// Used by one thread; the processes end with that thread.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/file/descriptor.h"
#include "drivers/hal/child_process.h"
#include "drivers/hal/hal_process.h"
#include "drivers/hal/hal_row.h"

namespace understudy::drivers {

class HalSession {
 public:
  /// `folder` of an exported configuration, which is started; empty: the one that runs. Throws InputError for
  /// a folder or a configuration that is not this machine's, MachineError where HAL does not start, is held
  /// by another program, or gives no samples.
  HalSession(const HalSettings& settings, const std::string& folder);
  ~HalSession() { close(); }
  HalSession(const HalSession&) = delete;
  HalSession& operator=(const HalSession&) = delete;

  void send(const HalRow& row) { append(row, settings_, outgoing_); }
  /// Hands on what was sent and waits for samples, which it appends. False: HAL is gone.
  bool exchange(std::vector<HalSample>& samples, std::chrono::milliseconds time);

 private:
  void open(const std::string& folder);
  void close();
  void hold_lock();
  void check_running() const;
  void open_streams();
  void skip_old_samples();

  const HalSettings settings_;
  Descriptor lock_;
  std::unique_ptr<HalProcess> hal_;  ///< where we started it
  std::unique_ptr<ChildProcess> streamer_, sampler_;
  std::string outgoing_, incoming_;
};

/// Opens the emergency-stop latch of the HAL that runs, whatever is queued. The next session may close it.
void open_latch();

}  // namespace understudy::drivers
