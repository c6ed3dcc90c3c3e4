// grblHAL 1.1f as senders know it: a character-counted receive buffer, `ok` or `error:N` for each line once
// it is planned, and real-time characters that pass the buffer (grbl v1.1 Interface).
#include <algorithm>
#include <cctype>
#include <deque>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "rehearsal/serving/controller_session.h"

namespace understudy::rehearsal {
namespace {

constexpr std::size_t kReceiveBuffer = 1024;  // [bytes], grblHAL's
constexpr std::size_t kLongestLine = 256;     // grblHAL; longer is error:11, but for its comment
// What is kept of a line: the rest of one that has no end may not fill the buffer.
constexpr std::size_t kKeptOfLine = kReceiveBuffer / 2;
constexpr char kReset = 0x18;

// Codes of grbl's errors and alarms.
constexpr int kExpectedCommandLetter = 1, kBadNumber = 2, kInvalidStatement = 3, kLocked = 9, kOverflow = 11,
              kUnsupported = 20, kNoFeed = 22, kInvalidTarget = 33, kIdleOnly = 8;
constexpr int kSoftLimit = 2, kAbortCycle = 3;

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

/// Of what the reader says of a line.
int error_of(const InputError& error) {
  const std::string what = error.what();
  if (says(what, "unknown word")) return kUnsupported;
  if (says(what, "starts no word")) return kExpectedCommandLetter;
  if (says(what, "needs a finite decimal number")) return kBadNumber;
  if (says(what, "without a feed") || says(what, "feed must be above")) return kNoFeed;
  return kInvalidTarget;
}

class GrblSession final : public ControllerSession {
 public:
  explicit GrblSession(ServedMachine& machine) : machine_(machine) {}

  void greet() override {
    say("");
    say("GrblHAL 1.1f ['$' or '$HELP' for help]");
  }

  std::size_t room() const override { return kReceiveBuffer - std::min(kReceiveBuffer, buffered()); }

  void receive(std::string_view bytes) override {
    for (const char c : bytes) {
      if (is_real_time(c)) {
        real_time(c);
      } else if (c == '\n' || c == '\r') {
        if (c == '\n' && after_return_ && line_.empty()) {
          after_return_ = false;
          continue;
        }
        after_return_ = c == '\r';
        lines_.push_back(line_);
        line_.clear();
      } else {
        after_return_ = false;
        if (line_.size() < kKeptOfLine) line_ += c;
      }
    }
  }

  void tick(double now) override {
    machine_.run_until(now);
    while (true) {
      if (answer_when_planned_) {
        if (!machine_.has_room() || (wait_for_rest_ && !machine_.idle())) return;
        say("ok");
        answer_when_planned_ = wait_for_rest_ = false;
      }
      if (lines_.empty() || aborted_) return;
      const std::string line = std::move(lines_.front());
      lines_.pop_front();
      answer(line);
    }
  }

  bool quiet() const override { return lines_.empty() && !answer_when_planned_; }
  bool aborted() const override { return aborted_; }

 private:
  static bool is_real_time(char c) {
    return c == '?' || c == '!' || c == '~' || c == kReset || static_cast<unsigned char>(c) >= 0x80;
  }

  std::size_t buffered() const {
    std::size_t bytes = line_.size();
    for (const std::string& line : lines_) bytes += line.size() + 1;
    return bytes;
  }

  void real_time(char c) {
    if (c == '?') say(status());
    if (c == '!' && !machine_.idle()) machine_.hold();
    if (c == '~') machine_.resume();
    if (c == kReset) reset();
    // 0x80 and above are overrides: this machine runs as the program says.
  }

  void reset() {
    lines_.clear();
    line_.clear();
    answer_when_planned_ = wait_for_rest_ = false;
    const bool moving = !machine_.idle();
    machine_.resume();
    if (moving) {
      machine_.drop();
      aborted_ = alarm_ = true;
      say(fmt::format("ALARM:{}", kAbortCycle));
    }
    greet();
    if (alarm_) say("[MSG:'$H'|'$X' to unlock]");
  }

  std::string state() const {
    if (alarm_) return "Alarm";
    if (machine_.held()) return "Hold:0";
    if (homing_ && !machine_.idle()) return "Home";
    return machine_.idle() ? "Idle" : "Run";
  }

  std::string status() const {
    const Vec3 p = machine_.X_WT().translation();
    return fmt::format("<{}|MPos:{:.3f},{:.3f},{:.3f}|Bf:{},{}|FS:{:.0f},0>", state(), to_mm(p.x()),
                       to_mm(p.y()), to_mm(p.z()), std::max(0, machine_.free_blocks()), room(),
                       machine_.speed() / kMillimetrePerMinute);
  }

  void answer(const std::string& line) {
    if (std::min(line.find(';'), line.size()) > kLongestLine) return error(kOverflow);
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string::npos) return say("ok");
    if (line[first] == '$') return setting(line.substr(first));
    if (alarm_) return error(kLocked);
    if (machine_.ended()) return say("ok");  // what follows M2 or M30 is none of the program
    try {
      machine_.take(line);
    } catch (const BeyondLimits& beyond) {
      alarm_ = true;
      say(fmt::format("[MSG:{}]", beyond.what()));
      say(fmt::format("ALARM:{}", kSoftLimit));
      return;
    } catch (const InputError& refused) {
      say(fmt::format("[MSG:{}]", refused.what()));
      return error(error_of(refused));
    }
    answer_when_planned_ = true;
    homing_ = false;
    if (machine_.ended()) {
      wait_for_rest_ = true;
      say("[MSG:Pgm End]");
    }
  }

  void setting(const std::string& line) {
    std::string word = line;
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (word == "$" || word == "$HELP") {
      say("[HLP:$$ $# $G $I $X $H ~ ! ? ctrl-x]");
    } else if (word == "$$") {
      settings();
    } else if (word == "$I") {
      say("[VER:1.1f.20240101:understudy]");
      say(fmt::format("[OPT:VN,{},{}]", planner_blocks("grbl"), kReceiveBuffer));
      say(fmt::format("[NAME:{}]", machine_.machine().name));
    } else if (word == "$G") {
      say(fmt::format("[GC:G1 G54 G17 G21 {} {} M5 M9 T0 F0 S0]", machine_.state().relative() ? "G91" : "G90",
                      machine_.state().inverse_time() ? "G93" : "G94"));
    } else if (word == "$#") {
      for (const char* system : {"G54", "G55", "G56", "G57", "G58", "G59", "G92"})
        say(fmt::format("[{}:0.000,0.000,0.000]", system));
    } else if (word == "$X") {
      if (alarm_) say("[MSG:Caution: Unlocked]");
      alarm_ = false;
    } else if (word == "$H") {
      return home();
    } else {
      return error(kInvalidStatement);
    }
    say("ok");
  }

  void home() {
    if (machine_.ended()) return say("ok");
    if (!machine_.idle()) return error(kIdleOnly);
    alarm_ = false;
    machine_.take("G28");
    homing_ = answer_when_planned_ = wait_for_rest_ = true;
  }

  /// Those that senders look at: travel, speeds and accelerations along X Y Z, report in mm.
  void settings() {
    const auto& machine = machine_.machine();
    say("$10=511");
    say("$13=0");
    say("$20=1");
    say("$22=1");
    for (int axis = 0; axis < 3; ++axis) {
      say(fmt::format("$11{}={:.3f}", axis, machine.travel_velocity / kMillimetrePerMinute));
      say(fmt::format("$12{}={:.3f}", axis, to_mm(machine.acceleration)));
    }
  }

  void error(int code) { say(fmt::format("error:{}", code)); }

  ServedMachine& machine_;
  std::string line_;
  std::deque<std::string> lines_;
  bool after_return_ = false, answer_when_planned_ = false, wait_for_rest_ = false;
  bool alarm_ = false, homing_ = false, aborted_ = false;
};

}  // namespace

std::unique_ptr<ControllerSession> make_grbl_session(ServedMachine& machine) {
  return std::make_unique<GrblSession>(machine);
}

}  // namespace understudy::rehearsal
