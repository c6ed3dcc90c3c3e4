#include "drivers/gcode/gcode_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::drivers {

using machine::AxisVector;
using machine::Fault;

namespace {

constexpr double kPoll = 0.05;   // [s], between two questions for the status
constexpr int kResendsMax = 20;  // for one line
constexpr int kProbesMax = 2;    // into silence
constexpr int kAsksMax = 3;      // for a position that is not as expected
constexpr int kIdleReports = 2;  // of a controller that has nothing left to do
constexpr std::string_view kGrblOrder = "XYZABCUVW";

}  // namespace

GcodeSession::GcodeSession(ByteLink& link, GcodeWriter writer, const SessionOptions& options)
    : LineSession(link, options), writer_(std::move(writer)) {}

void GcodeSession::push(std::string line, double duration, std::uint64_t executed) {
  Entry& entry = add(Role::line, std::move(line), duration);
  entry.executed = std::max(entry.executed, executed);
}

void GcodeSession::push_rest(const AxisVector& position) {
  if (!counts()) add(Role::wait, "M400");
  Entry& entry = counts() ? add(Role::rest, "") : add(Role::ask, "M114");
  entry.expected = position;
}

bool GcodeSession::push_outputs(const machine::Outputs& before, const machine::Outputs& after) {
  bool heats = false;
  for (const std::string& line : writer_.outputs(before, after)) {
    const bool waits = line.starts_with("M109");
    push(line, waits ? kHeatTime : 0, 0);
    heats = heats || waits;
  }
  return heats;
}

std::optional<Reply> GcodeSession::next_reply() {
  const auto line = next_line();
  return line ? std::optional(parse_reply(*line)) : std::nullopt;
}

void GcodeSession::handle(const Reply& reply) {
  using Kind = Reply::Kind;
  if (reply.kind != Kind::other) heard_ = link_.now();
  switch (reply.kind) {
    case Kind::ok:
      return accept();
    case Kind::resend:
      return resend_from(reply.number);
    case Kind::status:
      return take_status(reply.status);
    case Kind::position:
      return take_position(reply);
    case Kind::alarm:
      return fail(reply.number == 1 ? Fault::limit_switch : Fault::drive,
                  "the controller says " + reply.text);
    case Kind::banner:
      return fail(
          Fault::power,
          fmt::format("the controller was reset ('{}'): where it stands is not known any more", reply.text));
    case Kind::error: {
      // With a number of the last line, a resend follows.
      if (!counts() && reply.text.find("Last Line") != std::string::npos) return;
      const bool killed = reply.text.find("kill") != std::string::npos;
      const std::string about = accepted_ < sent_ ? fmt::format(" to '{}'", entries_[accepted_].text) : "";
      return fail(killed ? Fault::emergency_stop : Fault::drive,
                  fmt::format("the controller says '{}'{}", reply.text, about));
    }
    case Kind::busy:
    case Kind::other:
      return;
  }
}

void GcodeSession::accept() {
  if (skipped_oks_ > 0) {
    --skipped_oks_;
    return;
  }
  if (accepted_ == sent_) {
    // Numbers tell whether a line is missing; a count that is wrong once is wrong for good.
    if (counts()) fail(Fault::drive, "the controller says 'ok' to more lines than were sent");
    return;
  }
  const Entry& entry = entries_[accepted_];
  in_flight_ -= std::min(in_flight_, framed(entry).size());
  ++accepted_;
  accepted_at_ = link_.now();
  probes_ = idle_reports_ = 0;
  if (entry.role == Role::ask) settle_rest();
}

/// The controller has all lines before that one, and drops what comes until it.
void GcodeSession::resend_from(int number) {
  skipped_oks_ = 1;
  for (std::size_t i = 0; i <= sent_; ++i) {
    const bool is_next = i == sent_ && i > 0 && entries_[i - 1].number + 1 == number;
    if (!is_next && (i == sent_ || entries_[i].number != number)) continue;
    // Of one line in all: a controller may accept it, too, and ask for it again.
    if (++entries_[is_next ? i - 1 : i].resends > kResendsMax)
      return fail(Fault::drive, fmt::format("the controller asks {} times for line {}", kResendsMax, number));
    sent_ = accepted_ = i;
    in_flight_ = 0;
    outgoing_.clear();
    if (is_next && entries_[i - 1].role == Role::ask) {  // its answer was lost: ask again
      sent_ = accepted_ = i - 1;
      entries_[i - 1].number = 0;
    }
    return;
  }
  fail(Fault::drive, fmt::format("the controller asks for line {}, which it had accepted", number));
}

void GcodeSession::confirm_sent(std::size_t count) {
  confirm(count);
  sent_ -= count;
}

void GcodeSession::take_status(const ControllerStatus& status) {
  if (status.state == "Alarm" || status.state == "Door" || status.state == "Sleep")
    return fail(Fault::drive, "the controller is in the state " + status.state);
  if (!status.work_offset.empty()) work_offset_ = status.work_offset;
  std::vector<double> values = status.work;
  if (values.empty()) {
    values = status.machine;
    for (std::size_t i = 0; i < std::min(values.size(), work_offset_.size()); ++i)
      values[i] -= work_offset_[i];
  }
  const GcodeAxes& axes = writer_.axes();
  AxisVector position = position_;
  for (int i = 0; i < axes.count(); ++i) {
    const std::size_t at = kGrblOrder.find(axes.letters[static_cast<std::size_t>(i)]);
    if (at >= values.size()) return;  // a report that was cut
    position[static_cast<std::size_t>(i)] = values[at] * axes.unit(i);
  }
  note_position(position);
  if (status.planner_free) planner_size_ = std::max(planner_size_, *status.planner_free);
  const bool empty = !status.planner_free || *status.planner_free == planner_size_;
  idle_reports_ = status.state == "Idle" && empty ? idle_reports_ + 1 : 0;
  if (idle_reports_ >= kIdleReports && accepted_ < sent_ &&
      link_.now() - accepted_at_ > options_.reply_time + entries_[accepted_].duration)
    return fail(Fault::drive,
                fmt::format("the controller is idle and does not answer '{}': bytes of it are lost",
                            entries_[accepted_].text));
  if (status.line && *status.line > 0) {
    const auto running =
        std::find_if(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(accepted_),
                     [&](const Entry& e) { return e.number == *status.line; });
    if (running != entries_.begin() + static_cast<std::ptrdiff_t>(accepted_))
      confirm_sent(static_cast<std::size_t>(running - entries_.begin()));
  }
  // A rest is accepted with what is before it.
  while (accepted_ < entries_.size() && accepted_ == sent_ && entries_[accepted_].role == Role::rest)
    sent_ = ++accepted_;
  if (accepted_ > 0 && entries_[accepted_ - 1].role == Role::rest && idle_reports_ >= kIdleReports)
    settle_rest();
}

void GcodeSession::take_position(const Reply& reply) {
  const GcodeAxes& axes = writer_.axes();
  AxisVector position = position_;
  for (int i = 0; i < axes.count(); ++i) {
    const char letter = axes.letters[static_cast<std::size_t>(i)];
    const auto word = std::ranges::find(reply.words, letter, &std::pair<char, double>::first);
    if (word == reply.words.end()) return;
    position[static_cast<std::size_t>(i)] = word->second * axes.unit(i);
  }
  note_position(position);
}

bool GcodeSession::stands_at(const AxisVector& expected, std::string& off) const {
  // What the report is rounded to: grblHAL says three decimals, Marlin two.
  const double rounding = counts() ? 0.5e-3 : 5e-3;
  const GcodeAxes& axes = writer_.axes();
  for (int i = 0; i < axes.count(); ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double unit = axes.unit(i),
                 allowed = options_.step[axis] + 1.01 * rounding * unit + axes.grid.axes[axis];
    if (std::abs(position_[axis] - expected[axis]) <= allowed) continue;
    off = fmt::format("{} rests at {:.4f} where {:.4f} was asked for", axes.letters[axis],
                      position_[axis] / unit, expected[axis] / unit);
    return false;
  }
  return true;
}

/// The controller says that everything before the rest is done, and where it stands.
void GcodeSession::settle_rest() {
  const std::size_t last = accepted_ - 1;
  Entry& entry = entries_[last];
  std::string off = "the controller does not say where it stands";
  const bool good = position_fresh_ && stands_at(entry.expected, off);
  position_fresh_ = false;
  if (good) return confirm_sent(accepted_);
  if (++entry.asked >= kAsksMax) return fail(Fault::following_error, off);
  idle_reports_ = 0;
  if (entry.role == Role::rest) return;
  Entry again = entry;
  again.number = 0;
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(accepted_), again);
  entries_[last].role = Role::line;
}

std::string GcodeSession::framed(const Entry& entry) const {
  if (counts()) return fmt::format("N{}{}\n", entry.number, entry.text);
  std::string line = fmt::format("N{} {}", entry.number, entry.text);
  unsigned char sum = 0;
  for (const char c : line) sum = static_cast<unsigned char>(sum ^ static_cast<unsigned char>(c));
  return line + fmt::format("*{}\n", sum);
}

/// There is room for it, and nothing before it must be answered first.
bool GcodeSession::may_send(const Entry& entry) const {
  if (sent_ > 0 && entries_[sent_ - 1].role == Role::ask && accepted_ < sent_) return false;
  if (sent_ > 0 && entries_[sent_ - 1].role == Role::rest) return false;
  if (!counts()) return sent_ - accepted_ < static_cast<std::size_t>(options_.window);
  // Room for one line is kept, should an `ok` too many come.
  const std::size_t size = framed(entry).size();
  return in_flight_ == 0 || in_flight_ + 2 * size <= options_.receive_buffer;
}

void GcodeSession::send_lines() {
  if (counts() && link_.now() >= polled_ + kPoll) {
    polled_ = link_.now();
    send_now("?");
  }
  while (outgoing_.empty() && sent_ < entries_.size()) {
    Entry& entry = entries_[sent_];
    if (entry.role == Role::rest) return;
    if (entry.number == 0) entry.number = ++numbers_;
    if (!may_send(entry)) return;
    if (entry.role == Role::ask) position_fresh_ = false;
    if (accepted_ == sent_) accepted_at_ = link_.now();
    const std::string line = framed(entry);
    in_flight_ += line.size();
    outgoing_ += line;
    ++sent_;
    write_out();
  }
}

/// [s], of silence that is none to worry about: a full planner answers once it has room.
double GcodeSession::patience() const {
  double running = 0;
  if (!counts())
    for (std::size_t i = 0; i < sent_; ++i) running += entries_[i].duration;
  return options_.reply_time + running;
}

void GcodeSession::watch_silence() {
  const bool asked = counts() || accepted_ < sent_ || (sent_ < entries_.size() && !outgoing_.empty());
  if (!asked || link_.now() - heard_ <= patience()) return;
  if (!counts() && probes_ < kProbesMax && accepted_ < sent_) {
    // The line or its answer is lost. A number that it has it refuses, and says which it wants.
    ++probes_;
    heard_ = link_.now();
    sent_ = accepted_;
    in_flight_ = 0;
    skipped_oks_ = 0;
    outgoing_ = "\n";
    return;
  }
  fail(Fault::power, fmt::format("the controller has not answered for {:.1f} s", link_.now() - heard_));
}

/// Before all that waits to be sent.
void GcodeSession::send_now(std::string_view bytes) {
  try {
    if (outgoing_.empty() && link_.send(bytes) == bytes.size()) return;
    outgoing_.insert(0, bytes);
  } catch (const MachineError& error) {
    fail(Fault::power, error.what());
  }
}

/// At once, past everything.
void GcodeSession::emergency_stop() {
  if (counts())
    send_now("\x18");
  else
    last_words({"M112"});
  outputs_off();
}

/// After a fault or in an emergency: lines that nothing counts on.
void GcodeSession::last_words(const std::vector<std::string>& lines) {
  try {
    std::string text = "\n";
    for (const std::string& line : lines) text += line + "\n";
    static_cast<void>(link_.send(text));
  } catch (const MachineError&) {  // it is gone, and the fault that stands says so
  }
}

}  // namespace understudy::drivers
