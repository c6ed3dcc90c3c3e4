#include "tests/fuzz/controller_talk.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>

#include "drivers/gcode/gcode_reply.h"
#include "drivers/gcode/gcode_session.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

using namespace understudy::drivers;

/// Time passes in wait() alone; a piece comes with each.
class Script : public ByteLink {
 public:
  Script(std::string_view text, std::size_t piece) : text_(text), piece_(piece) {}

  double now() const override { return now_; }
  std::size_t send(std::string_view bytes) override {
    asked_ = asked_ || !bytes.empty();
    return bytes.size();
  }
  std::size_t receive(std::span<char> bytes) override {
    if (asked_ && text_.starts_with(kAwait)) {
      text_.remove_prefix(1);
      asked_ = false;
    }
    const std::size_t count = std::min({bytes.size(), ready_, text_.size(), text_.find(kAwait)});
    std::copy_n(text_.begin(), count, bytes.begin());
    text_.remove_prefix(count);
    ready_ -= count;
    return count;
  }
  void wait(double until) override {
    now_ = std::max(until, now_ + 1e-3);
    ready_ = piece_;
  }

 private:
  static constexpr char kAwait = '\f';

  std::string_view text_;
  std::size_t piece_, ready_ = 0;
  bool asked_ = false;
  double now_ = 0;
};

void check_reply(std::string_view line) {
  const Reply reply = parse_reply(line);
  for (const auto* values : {&reply.status.machine, &reply.status.work, &reply.status.work_offset})
    require_finite(*values, "position");
  for (const auto& [letter, value] : reply.words) require_finite(value, "position");
}

/// Of the text as it is sent, without its form feeds.
std::size_t oks(std::string text) {
  std::erase(text, '\f');
  std::istringstream lines(text);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) {
    check_reply(line);
    count += parse_reply(line).kind == Reply::Kind::ok ? 1 : 0;
  }
  return count;
}

GcodeWriter writer_of(GcodeFamily family) {
  GcodeAxes axes{"XYZ", 'E', {false, false, false}, {}};
  axes.grid.axes = {1e-6, 1e-6, 1e-6};
  return {family, axes};
}

/// Longer than any deadline of the session.
constexpr double kPatience = 600;  // [s]
constexpr std::uint64_t kLines = 8;

}  // namespace

bool talk(std::string_view text, GcodeFamily family, std::size_t piece) {
  const std::size_t accepted_at_most = oks(std::string(text));
  Script link(text, piece);
  const GcodeWriter writer = writer_of(family);
  GcodeSession session(link, writer, {});
  try {
    session.connect();
  } catch (const MachineError& error) {
    require(error.what()[0] != '\0', "a controller is refused without a word");
    return false;
  }
  for (std::uint64_t i = 1; i <= kLines; ++i) session.push("G1 X1 F600", 0.1, i);
  session.push_rest(session.position());
  while (!session.settled() && session.fault() == machine::Fault::none && link.now() < kPatience) {
    session.pump();
    link.wait(link.now() + 0.05);
  }
  require(session.settled() || session.fault() != machine::Fault::none, "neither done nor a fault");
  require(session.executed() <= accepted_at_most, "a line is called done that was not accepted");
  require(session.fault() == machine::Fault::none || !session.fault_text().empty(), "a fault without a word");
  require_finite(session.backlog(), "backlog");
  return session.settled();
}

bool talk(std::string_view input) {
  if (input.size() < 2) return false;
  constexpr std::array kFamilies{GcodeFamily::grblhal, GcodeFamily::marlin, GcodeFamily::reprapfirmware};
  const auto byte = [&input](std::size_t at) { return static_cast<unsigned char>(input[at]); };
  return talk(input.substr(2), kFamilies[byte(0) % kFamilies.size()], 1 + byte(1) % 64u);
}

}  // namespace understudy::fuzz
