#include "tests/drivers/gcode/scripted_controller.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace understudy::drivers {
namespace {

std::map<char, double> words_of(const std::string& line) {
  std::map<char, double> words;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (line[i] >= 'A' && line[i] <= 'Z') words[line[i]] = std::strtod(line.c_str() + i + 1, nullptr);
  return words;
}

}  // namespace

ScriptedController::ScriptedController(Setup setup, const Mischief& mischief)
    : setup_(std::move(setup)), mischief_(mischief), random_(mischief.seed), planned_(setup_.start) {
  if (numbers()) boot();  // opening the line resets it
}

void ScriptedController::boot() {
  if (setup_.firmware == Firmware::grblhal) say("GrblHAL 1.1f ['$' or '$HELP' for help]");
  if (setup_.firmware == Firmware::marlin) {
    say("start");
    say("echo:Marlin 2.1.2");
  }
}

void ScriptedController::say(const std::string& line) {
  if (mute_) return;
  double due = now_;
  if (mischief_.reply_delay > 0) due += std::uniform_real_distribution<>(0, mischief_.reply_delay)(random_);
  if (!late_.empty()) due = std::max(due, late_.back().due);
  if (happens(mischief_.garbage)) {
    std::string noise;
    for (int i = std::uniform_int_distribution<>(1, 12)(random_); i > 0; --i)
      noise += static_cast<char>(std::uniform_int_distribution<>(128, 255)(random_));
    late_.push_back({due, noise + "\n"});
  }
  late_.push_back({due, line + "\r\n"});
}

void ScriptedController::ok() {
  if (!happens(mischief_.lost_ok)) say("ok");
  if (happens(mischief_.stray_ok)) say("ok");
}

std::string ScriptedController::give() {
  std::string bytes;
  while (!late_.empty() && late_.front().due <= now_) {
    bytes += late_.front().text;
    late_.pop_front();
  }
  return bytes;
}

void ScriptedController::take(std::string_view bytes) {
  for (const char c : bytes) {
    if (mute_) continue;
    if (setup_.firmware == Firmware::grblhal && (c == '?' || c == '!' || c == '~' || c == 0x18)) {
      realtime(c);
      continue;
    }
    if (received_.size() < setup_.receive_buffer || numbers()) received_ += c;  // else it is lost
  }
}

void ScriptedController::realtime(char c) {
  if (c == '?') status();
  if (c != 0x18) return;
  received_.clear();
  planner_.clear();
  block_numbers_.clear();
  waiting_.clear();
  running_ = false;
  late_.clear();
  planned_ = where();
  boot();
}

std::array<double, 8> ScriptedController::where() const {
  if (planner_.empty() || !running_) return planner_.empty() ? planned_ : planner_.front().from;
  const Ran& block = planner_.front();
  const double share = std::clamp((now_ - block.begin) / (block.end - block.begin), 0.0, 1.0);
  std::array<double, 8> at{};
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = block.from[i] + share * (block.to[i] - block.from[i]);
  return at;
}

std::string ScriptedController::coordinates(const char* separator, int decimals, bool letters) const {
  const auto at = where();
  std::string text;
  for (std::size_t i = 0; i < setup_.letters.size(); ++i) {
    const double value = setup_.step > 0 ? std::round(at[i] / setup_.step) * setup_.step : at[i];
    if (i > 0) text += separator;
    if (letters) text += fmt::format("{}:", setup_.letters[i]);
    text += fmt::format("{:.{}f}", value, decimals);
  }
  return text;
}

void ScriptedController::status() {
  const bool idle = planner_.empty() && waiting_.empty();
  std::string text = fmt::format("<{}|MPos:{}|Bf:{},{}", idle ? "Idle" : "Run", coordinates(",", 3, false),
                                 setup_.planner - planner_.size(), setup_.receive_buffer - received_.size());
  if (running_ && !block_numbers_.empty()) text += fmt::format("|Ln:{}", block_numbers_.front());
  say(text + "|FS:0,0|WCO:0.000,0.000,0.000,0.000,0.000,0.000>");
}

/// The lines that a step of its loop gets through.
void ScriptedController::read_line() {
  if (now_ < busy_until_) return;
  if (!waiting_.empty()) {
    if (!planner_.empty()) return;
    if (waiting_ == "M109") temperature_ = 200;
    waiting_.clear();
    return ok();
  }
  if (planner_.size() >= setup_.planner) return;
  const auto end = received_.find('\n');
  if (end == std::string::npos) return;
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  busy_until_ = now_ + 0.5e-3;
  if (line.empty()) return;
  if (happens(mischief_.lost_line)) return;
  if (happens(mischief_.corrupt))
    line[std::uniform_int_distribution<std::size_t>(0, line.size() - 1)(random_)] ^= 0x10;
  if (numbers()) return numbered(line);
  if (line == "$H") return ok();
  line_of_block_ = 0;
  if (line[0] == 'N') {
    line_of_block_ = std::atoi(line.c_str() + 1);
    line.erase(0, line.find_first_not_of("0123456789", 1));
  }
  obey(line);
}

void ScriptedController::refuse(const std::string& why) {
  received_.clear();
  say(fmt::format("Error:{}, Last Line: {}", why, last_number_));
  say(fmt::format("Resend: {}", last_number_ + 1));
  ok();
}

void ScriptedController::numbered(std::string line) {
  const auto star = line.rfind('*');
  if (line[0] != 'N') {
    if (star != std::string::npos) return refuse("No Line Number with checksum");
    if (line.starts_with("M110 N")) last_number_ = std::atoi(line.c_str() + 6);
    return obey(line);
  }
  if (star == std::string::npos) return refuse("No Checksum with line number");
  const int number = std::atoi(line.c_str() + 1);
  if (setup_.firmware == Firmware::marlin && number != last_number_ + 1)
    return refuse("Line Number is not Last Line Number+1");
  unsigned char sum = 0;
  for (std::size_t i = 0; i < star; ++i)
    sum = static_cast<unsigned char>(sum ^ static_cast<unsigned char>(line[i]));
  if (sum != std::atoi(line.c_str() + star + 1)) return refuse("checksum mismatch");
  if (happens(mischief_.needless_resend)) return refuse("checksum mismatch");
  last_number_ = number;
  line = line.substr(0, star);
  line.erase(0, line.find(' ') + 1);
  obey(line);
}

void ScriptedController::obey(const std::string& words) {
  if (words.starts_with("G1 ")) return motion(words);
  if (words.starts_with("G4 ")) return motion(words);
  if (words == "G93") inverse_ = true;
  if (words == "M400" || words.starts_with("M109")) {
    waiting_ = words.substr(0, 4);
    if (waiting_ == "M109") busy_until_ = now_ + 2;
    return;
  }
  if (words == "M115")
    say(setup_.firmware == Firmware::marlin
            ? "FIRMWARE_NAME:Marlin 2.1.2 PROTOCOL_VERSION:1.0"
            : "FIRMWARE_NAME: RepRapFirmware for Duet 3 FIRMWARE_VERSION: 3.5.1");
  if (words == "M114")
    say(coordinates(" ", setup_.firmware == Firmware::marlin ? 2 : 3, true) +
        fmt::format(" E:{:.2f} Count X:0 Y:0 Z:0", planned_fed_));
  if (words.starts_with("M104")) temperature_ = words_of(words)['S'];
  ok();
}

/// By inverse time, or by feed as RS274/NGC counts it: X Y Z, else U V W, else A B C, else the filament.
double ScriptedController::duration_of(const std::array<double, 8>& to, double fed_to, double feed) const {
  if (inverse_) return 60 / feed;
  for (const char* group : {"XYZ", "UVW", "ABC"}) {
    double square = 0;
    for (std::size_t i = 0; i < setup_.letters.size(); ++i)
      if (std::string_view(group).find(setup_.letters[i]) != std::string_view::npos)
        square += (to[i] - planned_[i]) * (to[i] - planned_[i]);
    if (square > 0) return 60 * std::sqrt(square) / feed;
  }
  return 60 * std::abs(fed_to - planned_fed_) / feed;
}

void ScriptedController::motion(const std::string& words) {
  const auto values = words_of(words);
  Ran block;
  block.words = words;
  block.from = block.to = planned_;
  block.fed_from = block.fed_to = planned_fed_;
  double duration = 0;
  if (words.starts_with("G4")) {
    duration = values.at('P') * (numbers() ? 1e-3 : 1);
  } else {
    for (std::size_t i = 0; i < setup_.letters.size(); ++i)
      if (const auto word = values.find(setup_.letters[i]); word != values.end()) block.to[i] = word->second;
    if (const auto word = values.find(setup_.extruder); word != values.end()) block.fed_to = word->second;
    const auto feed = values.find('F');
    if (feed == values.end() || !(feed->second > 0)) return say("error:22");
    duration = duration_of(block.to, block.fed_to, feed->second);
  }
  block.end = duration;  // until it begins
  planned_ = block.to;
  planned_fed_ = block.fed_to;
  planner_.push_back(block);
  block_numbers_.push_back(line_of_block_);
  if (words.starts_with("G4"))
    waiting_ = "G4";
  else
    ok();
}

void ScriptedController::end_of_block() {
  ran_.push_back(planner_.front());
  planner_.pop_front();
  block_numbers_.pop_front();
  running_ = false;
}

void ScriptedController::accidents() {
  const auto due = [&](double& at) {
    if (!(at > 0) || now_ < at) return false;
    at = 0;
    return true;
  };
  if (due(mischief_.silent_at)) dead_ = mute_ = true;
  if (due(mischief_.reset_at)) {
    dead_ = true;
    planner_.clear();
    block_numbers_.clear();
    received_.clear();
    waiting_.clear();
    running_ = false;
    if (setup_.firmware == Firmware::reprapfirmware) mute_ = true;  // its USB device goes
    boot();
  }
  if (due(mischief_.alarm_at)) {
    dead_ = true;
    say(numbers() ? "Error:Printer halted. kill() called!" : "ALARM:1");
    planner_.clear();
    block_numbers_.clear();
    running_ = false;
  }
  if (due(mischief_.error_at)) {
    dead_ = true;
    say(numbers() ? "Error:Thermal runaway, system stopped!" : "error:20");
  }
}

void ScriptedController::run_to(double time) {
  constexpr double kStep = 0.5e-3;
  while (now_ < time) {
    const double next = std::min(time, now_ + kStep);
    // Blocks follow each other without a gap.
    double at = now_;
    while (!planner_.empty()) {
      Ran& block = planner_.front();
      if (!running_) {
        running_ = true;
        block.begin = at;
        block.end += at;
      }
      if (block.end > next) break;
      at = block.end;
      end_of_block();
    }
    now_ = next;
    accidents();
    read_line();
  }
}

}  // namespace understudy::drivers
