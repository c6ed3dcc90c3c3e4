// A conversation with linuxcncrsh, by which LinuxCNC's own planner and kinematics drive a hexapod.
//
// Blocks of pose words go as calls of the subroutines of `understudy export linuxcnc`, two in a line where
// they fit: linuxcncrsh takes ten lines a second. A line is accepted once LinuxCNC has received it; a rest is
// waited for by LinuxCNC itself (`set_wait done`, during which it answers nothing), and then its joints must
// stand where they were sent. An error that it tells, a stop or a machine that is off is a fault that stays.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/gcode/byte_link.h"
#include "drivers/gcode/controller.h"
#include "drivers/gcode/gcode_session.h"
#include "drivers/pose_words.h"

namespace understudy::drivers {

/// A further connection to the same LinuxCNC: for an emergency stop, while the first may be waiting.
using AnotherLink = std::function<std::unique_ptr<ByteLink>()>;

class LinuxcncSession : public Controller {
 public:
  /// Link and words must outlive the session. `another` may be empty.
  LinuxcncSession(ByteLink& link, PoseWords& words, const SessionOptions& options, AnotherLink another);

  void connect() override;
  void begin(const PathSample& at) override;
  void push(const Block& block) override;
  void push_rest(const machine::AxisVector& position) override;
  bool push_outputs(const machine::Outputs& before, const machine::Outputs& after) override;
  void pump() override;
  void outputs_off() override;
  void emergency_stop() override;

  bool settled() const override { return entries_.empty(); }
  double backlog() const override;
  std::uint64_t executed() const override { return executed_; }
  const machine::AxisVector& position() const override { return position_; }
  double position_time() const override { return position_time_; }
  machine::Fault fault() const override { return fault_; }
  const std::string& fault_text() const override { return fault_text_; }
  void fail(machine::Fault fault, const std::string& why) override;

 private:
  enum class Role { block, line, barrier, position };
  struct Entry {
    Role role = Role::line;
    std::string text;  ///< parameters of a block, or a line as it is sent
    double duration = 0;
    std::uint64_t executed = 0;
    machine::AxisVector expected{};  ///< of a position
    int asked = 0;
  };

  void add(Role role, std::string text, double duration = 0);
  void add_waiting(const std::string& line, double duration);
  std::string exchange(const std::string& lines, const std::string& begin, double seconds);
  void switch_on();
  void home();
  void set_modes();
  void check_kinematics();
  std::optional<std::string> next_line();
  void handle(const std::string& line);
  void accept();
  void take_joints(const std::string& line);
  void settle_position();
  void send_next();
  void ask();
  void write_out();
  void watch_silence();

  ByteLink& link_;
  PoseWords& words_;
  SessionOptions options_;
  AnotherLink another_;
  std::deque<Entry> entries_;  ///< not done, oldest first
  std::size_t accepted_ = 0;   ///< of them: received by LinuxCNC
  std::size_t in_flight_ = 0;  ///< of them, behind the accepted: sent in one line
  int questions_ = 0;          ///< that were asked and not answered
  double polled_ = 0, heard_ = 0;
  Block last_;
  std::string outgoing_, incoming_, refused_;
  std::uint64_t executed_ = 0;
  machine::AxisVector position_{};
  double position_time_ = 0;
  bool position_fresh_ = false;
  machine::Fault fault_ = machine::Fault::none;
  std::string fault_text_;
};

}  // namespace understudy::drivers
