#include "drivers/gcode/gcode_reply.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace understudy::drivers {
namespace {

constexpr double kBlocksMost = 1e6;  // that a planner has room for; more is no report

template <typename T>
std::optional<T> whole_number(std::string_view text) {
  T value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\r' || text.front() == '\t'))
    text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

/// The part up to `mark`, which goes with it.
std::string_view take_to(std::string_view& rest, char mark) {
  const std::size_t end = std::min(rest.find(mark), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return part;
}

/// "1.000,2.000"; false: one of them is no number.
bool read_values(std::string_view text, std::vector<double>& values) {
  while (!text.empty()) {
    const auto value = whole_number<double>(take_to(text, ','));
    if (!value || !std::isfinite(*value)) return false;
    values.push_back(*value);
  }
  return !values.empty();
}

std::optional<ControllerStatus> read_status(std::string_view text) {
  if (text.size() < 3 || text.front() != '<' || text.back() != '>') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  ControllerStatus status;
  status.state = std::string(take_to(text, '|'));
  status.state = status.state.substr(0, status.state.find(':'));
  if (status.state.empty()) return std::nullopt;
  while (!text.empty()) {
    std::string_view field = take_to(text, '|');
    const std::string_view key = take_to(field, ':');
    std::vector<double> values;
    if (key == "MPos" || key == "WPos" || key == "WCO") {
      if (!read_values(field, values)) return std::nullopt;
      (key == "MPos" ? status.machine : key == "WPos" ? status.work : status.work_offset) = values;
    } else if (key == "Ln") {
      status.line = whole_number<int>(field);
      if (!status.line) return std::nullopt;
    } else if (key == "Bf") {
      if (!read_values(field, values) || !(values[0] >= 0 && values[0] <= kBlocksMost)) return std::nullopt;
      status.planner_free = static_cast<int>(values[0]);
    }
  }
  return status;
}

/// "X:10.00 Y:0.00 E:0.00 Count X:800"; up to Count.
std::vector<std::pair<char, double>> read_position(std::string_view text) {
  std::vector<std::pair<char, double>> words;
  while (!text.empty()) {
    const std::string_view word = take_to(text, ' ');
    if (word.empty()) continue;
    if (word == "Count") break;
    if (word.size() < 3 || word[1] != ':' || word[0] < 'A' || word[0] > 'Z') return {};
    const auto value = whole_number<double>(word.substr(2));
    if (!value || !std::isfinite(*value)) return {};
    words.emplace_back(word[0], *value);
  }
  return words;
}

std::optional<int> number_behind(std::string_view text, std::string_view word) {
  if (!text.starts_with(word)) return std::nullopt;
  text = trimmed(text.substr(word.size()));
  if (text.starts_with('N')) text.remove_prefix(1);
  return whole_number<int>(text);
}

}  // namespace

Reply parse_reply(std::string_view line) {
  using Kind = Reply::Kind;
  Reply reply;
  const std::string_view text = trimmed(line);
  reply.text = std::string(text);
  if (text == "ok" || text.starts_with("ok ")) {
    reply.kind = Kind::ok;
    return reply;
  }
  for (const char* word : {"Resend:", "resend:", "rs"})
    if (const auto number = number_behind(text, word)) {
      reply.kind = Kind::resend;
      reply.number = *number;
      return reply;
    }
  if (const auto number = number_behind(text, "ALARM:")) {
    reply.kind = Kind::alarm;
    reply.number = *number;
  } else if (text.starts_with("error:") || text.starts_with("Error:") || text.starts_with("!!") ||
             text.find("Unknown command") != std::string_view::npos) {
    reply.kind = Kind::error;
    reply.number = number_behind(text, "error:").value_or(0);
  } else if (text == "start" || text.starts_with("Grbl ") || text.starts_with("GrblHAL ") ||
             text.starts_with("Marlin ")) {
    reply.kind = Kind::banner;
  } else if (text.starts_with("echo:busy") || text.starts_with("busy") || text.starts_with("T:") ||
             text.starts_with("[MSG:")) {
    reply.kind = Kind::busy;
  } else if (auto status = read_status(text)) {
    reply.kind = Kind::status;
    reply.status = std::move(*status);
  } else if (text.starts_with("X:")) {
    reply.words = read_position(text);
    if (!reply.words.empty()) reply.kind = Kind::position;
  }
  return reply;
}

}  // namespace understudy::drivers
