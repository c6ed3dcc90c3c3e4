// What any conversation by lines has: bytes to and from the link, a queue of what is not done yet, what the
// controller reported last, and the fault that stays. The lines themselves are its heirs' (gcode_session.h,
// linuxcnc_session.h).
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "drivers/gcode/byte_link.h"
#include "drivers/gcode/controller.h"

namespace understudy::drivers {

struct SessionOptions {
  std::size_t receive_buffer = 128;  ///< [bytes], of a controller that counts characters
  int window = 1;                    ///< lines on their way to one that numbers them
  double reply_time = 5;             ///< [s], in which it answers, beyond what it has to execute
  double boot_time = 10;             ///< [s], in which it comes up
  bool home = false;                 ///< it homes its axes before anything else
  machine::AxisVector step{};        ///< [m or rad], by which a position may be off at rest
};

class LineSession : public Controller {
 public:
  /// The link must outlive the session.
  LineSession(ByteLink& link, const SessionOptions& options);

  void pump() override;
  bool settled() const override { return entries_.empty(); }
  /// Of what was pushed and not accepted yet.
  double backlog() const override;
  std::uint64_t executed() const override { return executed_; }
  const machine::AxisVector& position() const override { return position_; }
  double position_time() const override { return position_time_; }
  machine::Fault fault() const override { return fault_; }
  const std::string& fault_text() const override { return fault_text_; }
  void fail(machine::Fault fault, const std::string& why) override;

 protected:
  /// wait: answered once all before it is done; ask: the answer is a position; rest: nothing is sent, the
  /// axes must stand there.
  enum class Role { line, block, wait, ask, rest };
  struct Entry {
    Role role = Role::line;
    std::string text;
    double duration = 0;  ///< [s], that it runs
    std::uint64_t executed = 0;
    machine::AxisVector expected{};  ///< of ask and rest
    int asked = 0;                   ///< how often the position was asked for
    int number = 0;                  ///< as it was sent; 0: not yet, or such lines have none
    int resends = 0;                 ///< how often the controller asked for it again
  };

  /// Behind the others; with it as many setpoints are done as with the one before.
  Entry& add(Role role, std::string text, double duration = 0);
  /// The first of the entries, all of them accepted, are done.
  void confirm(std::size_t count);
  void note_position(const machine::AxisVector& position);
  /// The next whole line that came, without its end.
  std::optional<std::string> next_line();
  void write_out();

  virtual void handle(const std::string& line) = 0;
  virtual void send_lines() = 0;     ///< what may be sent now
  virtual void watch_silence() = 0;  ///< fails where an answer is overdue

  ByteLink& link_;
  const SessionOptions options_;
  std::deque<Entry> entries_;  ///< not done, oldest first
  std::size_t accepted_ = 0;   ///< of them
  std::string outgoing_;
  double heard_ = 0, polled_ = 0;  ///< [s], link's clock
  machine::AxisVector position_{};
  bool position_fresh_ = false;  ///< came since it was asked for

 private:
  std::string incoming_;
  std::uint64_t executed_ = 0;
  double position_time_ = 0;
  machine::Fault fault_ = machine::Fault::none;
  std::string fault_text_;
};

}  // namespace understudy::drivers
