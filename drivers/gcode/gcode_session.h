// A conversation with a controller that loses, repeats and reorders nothing that it then calls done.
//
// Lines are accepted one by one (`ok`), by counting characters (grblHAL) or by number with resend (Marlin,
// RepRapFirmware). Accepted is not executed: that is what a rest says, at which the controller reports that
// it stands where the last line led. What the controller says of faults is kept, and nothing is sent after
// it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/gcode/gcode_reply.h"
#include "drivers/gcode/gcode_words.h"
#include "drivers/gcode/line_session.h"

namespace understudy::drivers {

class GcodeSession : public LineSession {
 public:
  /// The link must outlive the session.
  GcodeSession(ByteLink& link, GcodeWriter writer, const SessionOptions& options);

  void connect() override;
  void begin(const PathSample& at) override { writer_.begin(at); }
  void push(const Block& block) override { push(writer_.block(block), block.duration, block.executed); }
  void push_rest(const machine::AxisVector& position) override;
  bool push_outputs(const machine::Outputs& before, const machine::Outputs& after) override;
  void outputs_off() override { last_words(writer_.outputs({1e3, 1}, {})); }
  void emergency_stop() override;
  /// A line to be sent; `duration` [s] it runs, `executed` setpoints once it is done, or as many as before.
  void push(std::string line, double duration, std::uint64_t executed);

 private:
  bool counts() const { return writer_.family() == GcodeFamily::grblhal; }
  std::string exchange(const std::string& line, double seconds, Reply::Kind until);
  void greet_status(const ControllerStatus& status, Reply::Kind until);
  void greet_counting();
  void greet_numbering();
  std::optional<Reply> next_reply();
  void handle(const std::string& line) override { handle(parse_reply(line)); }
  void handle(const Reply& reply);
  void accept();
  void resend_from(int number);
  void confirm_sent(std::size_t count);
  void take_status(const ControllerStatus& status);
  void take_position(const Reply& reply);
  void settle_rest();
  bool stands_at(const machine::AxisVector& expected, std::string& off) const;
  void send_lines() override;
  bool may_send(const Entry& entry) const;
  std::string framed(const Entry& entry) const;
  void watch_silence() override;
  void send_now(std::string_view bytes);
  void last_words(const std::vector<std::string>& lines);
  double patience() const;

  GcodeWriter writer_;
  std::size_t sent_ = 0;       ///< of the entries
  std::size_t in_flight_ = 0;  ///< [bytes], sent and not accepted
  int numbers_ = 0;            ///< given so far
  int skipped_oks_ = 0;        ///< that belong to resends
  int probes_ = 0;             ///< since the last line was accepted
  int idle_reports_ = 0;       ///< in a row, since the last line was accepted
  double accepted_at_ = 0;     ///< [s], the last line, or since when there is one to be accepted
  std::vector<double> work_offset_;
  int planner_size_ = 0;  ///< blocks, the most that were ever free
  std::string firmware_;  ///< what it said of itself
};

}  // namespace understudy::drivers
