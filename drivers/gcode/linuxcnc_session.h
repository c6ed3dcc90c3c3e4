// A conversation with linuxcncrsh, by which LinuxCNC's own planner and kinematics drive a hexapod.
//
// Blocks of pose words go as calls of the subroutines of `understudy export linuxcnc`, two in a line where
// they fit: linuxcncrsh takes ten lines a second. A line is accepted once LinuxCNC has received it; a rest is
// waited for by LinuxCNC itself (`set_wait done`, during which it answers nothing), and then its joints must
// stand where they were sent. An error that it tells, a stop or a machine that is off is a fault that stays.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "drivers/gcode/line_session.h"
#include "drivers/pose_words.h"

namespace understudy::drivers {

/// A further connection to the same LinuxCNC: for an emergency stop, while the first may be waiting.
using AnotherLink = std::function<std::unique_ptr<ByteLink>()>;

class LinuxcncSession : public LineSession {
 public:
  /// Link and words must outlive the session. `another` may be empty.
  LinuxcncSession(ByteLink& link, PoseWords& words, const SessionOptions& options, AnotherLink another);

  void connect() override;
  void begin(const PathSample& at) override;
  void push(const Block& block) override;
  void push_rest(const machine::AxisVector& position) override;
  bool push_outputs(const machine::Outputs& before, const machine::Outputs& after) override;
  void outputs_off() override;
  void emergency_stop() override;

 private:
  void add_waiting(const std::string& line, double duration);
  std::string exchange(const std::string& lines, const std::string& begin, double seconds);
  void switch_on();
  void home();
  void set_modes();
  void check_kinematics();
  void handle(const std::string& line) override;
  void accept();
  void take_joints(const std::string& line);
  void settle_rest();
  void send_lines() override;
  void ask();
  void watch_silence() override;

  PoseWords& words_;
  AnotherLink another_;
  std::size_t in_flight_ = 0;  ///< of the entries, behind the accepted: sent in one line
  int questions_ = 0;          ///< that were asked and not answered
  Block last_;
  std::string refused_;
};

}  // namespace understudy::drivers
