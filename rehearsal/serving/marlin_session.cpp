// Marlin 2 as senders know it: line numbers and checksums with Resend, `ok` for each line once it is planned,
// queries answered before their `ok` (marlinfw.org/docs/gcode).
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "rehearsal/serving/controller_session.h"

namespace understudy::rehearsal {
namespace {

constexpr std::size_t kLongestLine = 96;                  // MAX_CMD_SIZE
constexpr std::size_t kReceiveBuffer = 4 * kLongestLine;  // BUFSIZE lines
constexpr std::size_t kKeptOfLine = kReceiveBuffer / 2;   // the rest of one without an end may not fill it
constexpr long kLastLineNumber = std::numeric_limits<std::int32_t>::max() - 1;
constexpr double kBusyEvery = 2;  // [s], HOST_KEEPALIVE

/// A line as it came, without what guards it.
struct Command {
  std::optional<long> number;
  std::string text;
};

std::string without_comment(const std::string& line) {
  std::string text = line.substr(0, line.find(';'));
  const auto first = text.find_first_not_of(" \t");
  const auto last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// "M105" of "M105 S1"; upper case.
std::string code_of(const std::string& text) {
  std::size_t end = text.empty() ? 0 : 1;
  while (end < text.size() && (std::isdigit(static_cast<unsigned char>(text[end])) != 0 || text[end] == '.'))
    ++end;
  std::string code = text.substr(0, end);
  for (char& c : code) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return code;
}

unsigned checksum_of(std::string_view bytes) {
  unsigned sum = 0;
  for (const char c : bytes) sum ^= static_cast<unsigned char>(c);
  return sum;
}

class MarlinSession final : public ControllerSession {
 public:
  explicit MarlinSession(ServedMachine& machine) : machine_(machine) {}

  void greet() override {
    say("start");
    say("echo:Marlin 2.1.2 (understudy)");
    say(fmt::format("echo: Machine: {}", machine_.machine().name));
  }

  std::size_t room() const override {
    std::size_t bytes = line_.size();
    for (const Command& command : commands_) bytes += command.text.size() + 1;
    return kReceiveBuffer - std::min(kReceiveBuffer, bytes);
  }

  void receive(std::string_view bytes) override {
    for (const char c : bytes) {
      if (c != '\n' && c != '\r') {
        if (line_.size() < kKeptOfLine) line_ += c;
        continue;
      }
      const std::string line = std::exchange(line_, {});
      if (!without_comment(line).empty()) accept(line);
    }
  }

  void tick(double now) override {
    machine_.run_until(now);
    while (true) {
      if (answer_due_) {
        if (!machine_.has_room() || (wait_for_rest_ && !machine_.idle())) return stay_busy(now);
        say("ok");
        answer_due_ = wait_for_rest_ = false;
      }
      busy_at_ = now;
      if (commands_.empty() || aborted_) return;
      const Command command = std::move(commands_.front());
      commands_.pop_front();
      run(command.text);
    }
  }

  bool quiet() const override { return commands_.empty() && !answer_due_; }
  bool aborted() const override { return aborted_; }

 private:
  void stay_busy(double now) {
    if (now - busy_at_ < kBusyEvery) return;
    busy_at_ = now;
    say("echo:busy: processing");
  }

  /// N and * are looked at as the bytes come, before the command queue.
  void accept(const std::string& line) {
    std::string text = line;
    const auto first = text.find_first_not_of(" \t");
    text.erase(0, first);
    if (text[0] != 'N') {
      if (const auto star = text.rfind('*'); star != std::string::npos)
        return again("No Line Number with checksum");
      return keep({std::nullopt, without_comment(text)});
    }
    long number = 0;
    const auto* begin = text.data() + 1;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
    if (error != std::errc() || number > kLastLineNumber)
      return again("Line Number is not Last Line Number+1");
    const auto star = text.rfind('*');
    const bool renumber = text.find("M110") != std::string::npos;
    if (star == std::string::npos) return again("No Checksum with line number");
    if (std::strtoul(text.c_str() + star + 1, nullptr, 10) !=
        checksum_of(std::string_view(text).substr(0, star)))
      return again("checksum mismatch");
    if (number != last_line_ + 1 && !renumber) return again("Line Number is not Last Line Number+1");
    last_line_ = number;
    const auto body = static_cast<std::size_t>(end - text.data());
    keep({number, without_comment(text.substr(body, star - body))});
  }

  /// What comes after a line that is asked for again is not of the order that the sender meant.
  void again(const char* why) {
    say(fmt::format("Error:{}, Last Line: {}", why, last_line_));
    say(fmt::format("Resend: {}", last_line_ + 1));
    say("ok");
  }

  void keep(Command command) {
    const std::string code = code_of(command.text);
    if (code == "M112") return emergency();
    if (command.text.size() > kLongestLine) {
      say(fmt::format("echo:Unknown command: \"{}\"", printable(command.text.substr(0, kLongestLine))));
      say("ok");
      return;
    }
    // A number alone is a line that its sender waits for, too.
    if (!command.text.empty() || command.number) commands_.push_back(std::move(command));
  }

  void emergency() {
    say("Error:Printer halted. kill() called!");
    commands_.clear();
    answer_due_ = false;
    machine_.drop();
    aborted_ = true;
  }

  void run(const std::string& text) {
    const std::string code = code_of(text);
    answer_due_ = true;
    if (code == "M105")
      say_temperatures();
    else if (code == "M114")
      say_position();
    else if (code == "M115")
      say_firmware();
    else if (code == "M110")
      renumber(text);
    else if (code == "M400")
      wait_for_rest_ = true;
    else if (!code.empty() && code != "M155" && code != "M113" && code != "M108" && code != "M503" &&
             code != "M31")
      take(text, code);
  }

  void take(const std::string& text, const std::string& code) {
    if (machine_.ended()) return;
    try {
      machine_.take(text);
    } catch (const BeyondLimits& beyond) {
      say(fmt::format("Error:{}", beyond.what()));
      return;
    } catch (const InputError& refused) {
      const std::string what = refused.what();
      if (what.find("unknown word") != std::string::npos)
        say(fmt::format("echo:Unknown command: \"{}\"", printable(text)));
      else
        say(fmt::format("Error:{}", what));
      return;
    }
    wait_for_rest_ =
        code == "G28" || code == "G4" || code == "M0" || code == "M1" || code == "M2" || code == "M30";
  }

  void renumber(const std::string& text) {
    const auto n = text.find('N', 4);
    if (n != std::string::npos)
      last_line_ = std::clamp(std::strtol(text.c_str() + n + 1, nullptr, 10), -1L, kLastLineNumber);
  }

  void say_temperatures() {
    const double nozzle = machine_.temperature() > 0 ? machine_.temperature() - kCelsiusZero : 0;
    const double now =
        machine_.temperature() > 0 ? nozzle : machine_.machine().process.ambient_temperature - kCelsiusZero;
    answer_due_ = false;
    say(fmt::format("ok T:{:.2f} /{:.2f} B:{:.2f} /0.00 @:0 B@:0", now, nozzle,
                    machine_.machine().process.ambient_temperature - kCelsiusZero));
  }

  void say_position() {
    const Vec3 p = machine_.X_WT().translation();
    say(fmt::format("X:{:.2f} Y:{:.2f} Z:{:.2f} E:{:.2f} Count X:{:.0f} Y:{:.0f} Z:{:.0f}", to_mm(p.x()),
                    to_mm(p.y()), to_mm(p.z()), to_mm(machine_.filament()), 1e3 * to_mm(p.x()),
                    1e3 * to_mm(p.y()), 1e3 * to_mm(p.z())));
  }

  void say_firmware() {
    say(
        fmt::format("FIRMWARE_NAME:Marlin 2.1.2 (understudy) SOURCE_CODE_URL:none PROTOCOL_VERSION:1.0 "
                    "MACHINE_TYPE:{} EXTRUDER_COUNT:1 UUID:00000000-0000-0000-0000-000000000000",
                    machine_.machine().name));
    for (const char* what :
         {"SERIAL_XON_XOFF:0", "EEPROM:0", "AUTOREPORT_TEMP:0", "PROGRESS:0", "EMERGENCY_PARSER:1"})
      say(fmt::format("Cap:{}", what));
  }

  ServedMachine& machine_;
  std::string line_;
  std::deque<Command> commands_;
  long last_line_ = 0;
  bool answer_due_ = false, wait_for_rest_ = false, aborted_ = false;
  double busy_at_ = 0;
};

}  // namespace

std::unique_ptr<ControllerSession> make_marlin_session(ServedMachine& machine) {
  return std::make_unique<MarlinSession>(machine);
}

}  // namespace understudy::rehearsal
