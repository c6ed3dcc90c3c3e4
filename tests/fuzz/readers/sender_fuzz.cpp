// Bytes as a sender's, of a print over a serial line: to grblHAL and to Marlin, in pieces as their buffers
// take them.
#include <algorithm>
#include <sstream>

#include "control/program/gcode_options.h"
#include "core/text/printable.h"
#include "rehearsal/serving/controller_session.h"
#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

using rehearsal::ControllerSession;
using rehearsal::ServedMachine;

constexpr double kBetween = 2e-3;  // [s], of the machine's clock, between two pieces
constexpr int kLooks = 20;         // before a sender whose bytes are not taken gives up
constexpr std::size_t kPiece = 64;

/// Lines that begin with "ok" or "error:".
int answers_in(const std::string& heard) {
  std::istringstream lines(heard);
  int found = 0;
  for (std::string line; std::getline(lines, line);)
    found += line.starts_with("ok") || line.starts_with("error:") ? 1 : 0;
  return found;
}

std::string print(ControllerSession& session, std::string_view bytes) {
  double now = 0;
  std::string heard;
  int waited = 0;
  session.greet();
  while (!bytes.empty() && waited < kLooks && !session.aborted()) {
    const std::size_t taken = std::min({session.room(), kPiece, bytes.size()});
    require(taken > 0 || !session.quiet(), "a buffer that is full without a line to answer");
    waited = taken > 0 ? 0 : waited + 1;
    session.receive(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    session.tick(now += kBetween);
    heard += session.take_output();
  }
  return heard;
}

void check_answers(const std::string& heard, std::string_view bytes) {
  std::istringstream lines(heard);
  for (std::string line; std::getline(lines, line);) {
    const std::string text = line.substr(0, line.find('\r'));
    require(printable(text) == text, "an answer that is no text");
  }
  const auto ends = std::count_if(bytes.begin(), bytes.end(), [](char c) { return c == '\n' || c == '\r'; });
  require(answers_in(heard) <= ends, "more answers than lines");
}

/// What was received is the program that is rehearsed.
void check_program_of(const ServedMachine& served, const toolpath::GcodeOptions& options) {
  require_finite(served.X_WT(), "the pose");
  require_finite(std::vector{served.filament(), served.temperature(), served.fan(), served.speed()},
                 "the state");
  if (served.moves() == 0) return;  // a file without a move is none
  const toolpath::Program program = toolpath::parse_gcode(served.text(), "received.gcode", options);
  require(std::count_if(program.steps.begin(), program.steps.end(),
                        [](const toolpath::Step& step) { return toolpath::moves(step); }) == served.moves(),
          "the received program has other moves than those that were taken");
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const auto machine = machine::load_machine("hexapod");
  static const auto options = [] {
    toolpath::GcodeOptions read = control::gcode_options({}, machine);
    read.chords_max = fuzz::kChords;
    return read;
  }();
  const std::string_view bytes = fuzz::text_of(data, size);
  for (const std::string& dialect : rehearsal::session_dialects()) {
    rehearsal::ServedMachine served(machine, options, rehearsal::planner_blocks(dialect));
    const auto session = rehearsal::make_session(dialect, served);
    const double begin = fuzz::processor_time();
    const std::string heard = fuzz::print(*session, bytes);
    fuzz::check_time(fuzz::processor_time() - begin, size, static_cast<std::size_t>(served.moves()));
    fuzz::check_answers(heard, bytes);
    if (served.whole()) fuzz::check_program_of(served, options);
  }
  return 0;
}
