#include "drivers/gcode/line_session.h"

#include <array>
#include <cassert>
#include <utility>

#include "core/error.h"

namespace understudy::drivers {

using machine::AxisVector;
using machine::Fault;

namespace {

constexpr std::size_t kLineMax = 1024;  // [bytes], of a reply; garbage without an end is dropped

}  // namespace

LineSession::LineSession(ByteLink& link, const SessionOptions& options)
    : link_(link), options_(options), heard_(link.now()) {}

void LineSession::fail(Fault fault, const std::string& why) {
  if (fault_ != Fault::none) return;
  fault_ = fault;
  fault_text_ = why;
}

LineSession::Entry& LineSession::add(Role role, std::string text, double duration) {
  if (entries_.empty()) heard_ = link_.now();
  Entry entry;
  entry.role = role;
  entry.text = std::move(text);
  entry.duration = duration;
  entry.executed = entries_.empty() ? executed_ : entries_.back().executed;
  return entries_.emplace_back(std::move(entry));
}

void LineSession::confirm(std::size_t count) {
  if (count == 0) return;
  assert(count <= accepted_);
  executed_ = entries_[count - 1].executed;
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(count));
  accepted_ -= count;
}

double LineSession::backlog() const {
  double sum = 0;
  for (std::size_t i = accepted_; i < entries_.size(); ++i) sum += entries_[i].duration;
  return sum;
}

void LineSession::note_position(const AxisVector& position) {
  position_ = position;
  position_time_ = link_.now();
  position_fresh_ = true;
}

void LineSession::pump() {
  if (fault_ != Fault::none) return;
  try {
    while (const auto line = next_line()) {
      handle(*line);
      if (fault_ != Fault::none) return;
    }
    send_lines();
    write_out();
    watch_silence();
  } catch (const MachineError& error) {
    fail(Fault::power, error.what());
  }
}

std::optional<std::string> LineSession::next_line() {
  std::array<char, 512> bytes;
  while (true) {
    const std::size_t end = incoming_.find_first_of("\r\n");
    if (end != std::string::npos) {
      std::string line = incoming_.substr(0, end);
      incoming_.erase(0, end + 1);
      if (!line.empty()) return line;
      continue;
    }
    if (incoming_.size() > kLineMax) incoming_.clear();
    const std::size_t count = link_.receive(bytes);
    if (count == 0) return std::nullopt;
    incoming_.append(bytes.data(), count);
  }
}

void LineSession::write_out() {
  while (!outgoing_.empty()) {
    const std::size_t taken = link_.send(outgoing_);
    if (taken == 0) return;
    outgoing_.erase(0, taken);
  }
}

}  // namespace understudy::drivers
