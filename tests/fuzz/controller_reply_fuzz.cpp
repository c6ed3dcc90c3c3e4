// Bytes as what a controller says on the line: of a family that is chosen by the first byte, in pieces of the
// length of the second. The session must end in an answer or a fault, and must call nothing done that was not
// accepted.
#include <algorithm>
#include <array>

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
    sent_ += bytes.size();
    return bytes.size();
  }
  std::size_t receive(std::span<char> bytes) override {
    const std::size_t count = std::min({bytes.size(), ready_, text_.size()});
    std::copy_n(text_.begin(), count, bytes.begin());
    text_.remove_prefix(count);
    ready_ -= count;
    return count;
  }
  void wait(double until) override {
    now_ = std::max(until, now_ + 1e-3);
    ready_ = piece_;
  }
  std::size_t sent() const { return sent_; }

 private:
  std::string_view text_;
  std::size_t piece_, ready_ = 0, sent_ = 0;
  double now_ = 0;
};

void check_reply(std::string_view line) {
  const Reply reply = parse_reply(line);
  for (const auto* values : {&reply.status.machine, &reply.status.work, &reply.status.work_offset})
    require_finite(*values, "position");
  for (const auto& [letter, value] : reply.words) require_finite(value, "position");
}

std::size_t oks(std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    check_reply(text.substr(0, end));
    count += parse_reply(text.substr(0, end)).kind == Reply::Kind::ok ? 1 : 0;
    text.remove_prefix(std::min(end + 1, text.size()));
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

void talk(std::string_view text, GcodeFamily family, std::size_t piece) {
  const std::size_t accepted_at_most = oks(text);
  Script link(text, piece);
  const GcodeWriter writer = writer_of(family);
  GcodeSession session(link, writer, {});
  try {
    session.connect();
  } catch (const MachineError& error) {
    require(error.what()[0] != '\0', "a controller is refused without a word");
    return;
  }
  for (std::uint64_t i = 1; i <= kLines; ++i) session.push("G1 X1 F600", 0.1, i);
  while (!session.settled() && session.fault() == machine::Fault::none && link.now() < kPatience) {
    session.pump();
    link.wait(link.now() + 0.05);
  }
  require(session.settled() || session.fault() != machine::Fault::none, "neither done nor a fault");
  require(session.executed() <= accepted_at_most, "a line is called done that was not accepted");
  require(session.fault() == machine::Fault::none || !session.fault_text().empty(), "a fault without a word");
  require_finite(session.backlog(), "backlog");
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  using drivers::GcodeFamily;
  if (size < 2) return 0;
  constexpr std::array kFamilies{GcodeFamily::grblhal, GcodeFamily::marlin, GcodeFamily::reprapfirmware};
  fuzz::talk(fuzz::text_of(data + 2, size - 2), kFamilies[data[0] % kFamilies.size()], 1 + data[1] % 64u);
  return 0;
}
