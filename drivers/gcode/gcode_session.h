// A conversation with a controller that loses, repeats and reorders nothing that it then calls done.
//
// Lines are accepted one by one (`ok`), by counting characters (grblHAL) or by number with resend (Marlin,
// RepRapFirmware). Accepted is not executed: that is what a rest says, at which the controller reports that
// it stands where the last line led. What the controller says of faults is kept, and nothing is sent after
// it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/gcode/byte_link.h"
#include "drivers/gcode/controller.h"
#include "drivers/gcode/gcode_reply.h"
#include "drivers/gcode/gcode_words.h"

namespace understudy::drivers {

struct SessionOptions {
  std::size_t receive_buffer = 128;  ///< [bytes], of a controller that counts characters
  int window = 1;                    ///< lines on their way to one that numbers them
  double reply_time = 5;             ///< [s], in which it answers, beyond what it has to execute
  double boot_time = 10;             ///< [s], in which it comes up
  bool home = false;                 ///< it homes its axes before anything else
  machine::AxisVector step{};        ///< [m or rad], by which a position may be off at rest
};

class GcodeSession : public Controller {
 public:
  /// The link must outlive the session.
  GcodeSession(ByteLink& link, GcodeWriter writer, const SessionOptions& options);

  void connect() override;
  void begin(const PathSample& at) override { writer_.begin(at); }
  void push(const Block& block) override { push(writer_.block(block), block.duration, block.executed); }
  void push_rest(const machine::AxisVector& position) override;
  bool push_outputs(const machine::Outputs& before, const machine::Outputs& after) override;
  void pump() override;
  void outputs_off() override { last_words(writer_.outputs({1e3, 1}, {})); }
  void emergency_stop() override;
  /// A line to be sent; `duration` [s] it runs, `executed` setpoints once it is done, or as many as before.
  void push(std::string line, double duration, std::uint64_t executed);

  bool settled() const override { return entries_.empty(); }
  /// Of what was pushed and not accepted yet.
  double backlog() const override;
  std::uint64_t executed() const override { return executed_; }
  const machine::AxisVector& position() const override { return position_; }
  double position_time() const override { return position_time_; }

  machine::Fault fault() const override { return fault_; }
  const std::string& fault_text() const override { return fault_text_; }
  void fail(machine::Fault fault, const std::string& why) override;

 private:
  enum class Role { line, wait, ask, rest };  ///< rest: of grblHAL, nothing is sent
  struct Entry {
    std::string text;
    double duration = 0;
    std::uint64_t executed = 0;
    Role role = Role::line;
    int number = 0;                  ///< as it was sent; 0: not yet
    machine::AxisVector expected{};  ///< of ask and rest
    int asked = 0;                   ///< how often the position was asked for
  };

  bool counts() const { return writer_.family() == GcodeFamily::grblhal; }
  std::string exchange(const std::string& line, double seconds, Reply::Kind until);
  void greet_status(const ControllerStatus& status, Reply::Kind until);
  void greet_counting();
  void greet_numbering();
  std::optional<Reply> next_reply();
  void handle(const Reply& reply);
  void accept();
  void resend_from(int number);
  void confirm(std::size_t count);
  void take_status(const ControllerStatus& status);
  void take_position(const Reply& reply);
  void settle_rest();
  bool stands_at(const machine::AxisVector& expected, std::string& off) const;
  void send_lines();
  bool may_send(const Entry& entry) const;
  std::string framed(const Entry& entry) const;
  void write_out();
  void watch_silence();
  void send_now(std::string_view bytes);
  void last_words(const std::vector<std::string>& lines);
  double patience() const;

  ByteLink& link_;
  GcodeWriter writer_;
  SessionOptions options_;
  std::deque<Entry> entries_;     ///< not confirmed, oldest first
  std::size_t sent_ = 0;          ///< of them
  std::size_t accepted_ = 0;      ///< of them
  std::size_t in_flight_ = 0;     ///< [bytes], sent and not accepted
  int numbers_ = 0;               ///< given so far
  int skipped_oks_ = 0;           ///< that belong to resends
  int resends_ = 0, probes_ = 0;  ///< since the last line was accepted
  int idle_reports_ = 0;          ///< in a row, since the last line was accepted
  std::string outgoing_, incoming_;
  double heard_ = 0, polled_ = 0;  ///< [s], link's clock
  double accepted_at_ = 0;         ///< [s], the last line, or since when there is one to be accepted
  std::vector<double> work_offset_;
  int planner_size_ = 0;  ///< blocks, the most that were ever free
  std::uint64_t executed_ = 0;
  machine::AxisVector position_{};
  double position_time_ = 0;
  bool position_fresh_ = false;  ///< came since it was asked for
  machine::Fault fault_ = machine::Fault::none;
  std::string fault_text_;
  std::string firmware_;  ///< what it said of itself
};

}  // namespace understudy::drivers
