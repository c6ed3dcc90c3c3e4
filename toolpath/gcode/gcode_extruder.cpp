#include "toolpath/gcode/gcode_extruder.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "toolpath/gcode/gcode_position.h"
#include "toolpath/gcode/words/gcode_limits.h"

namespace understudy::toolpath {
namespace {

constexpr double kLongestRetraction = 1;  // [m]
constexpr double kNoTool = 255;           // and above: Bambu's words for none

}  // namespace

void GcodeExtruder::take_saved(const GcodeExtruder& saved) {
  reading_ = saved.reading_;
  flow_ = saved.flow_;
  relative_ = saved.relative_;
}

double GcodeExtruder::feed(Block& block, double unit, bool counts_on) {
  const Word* word = block.take('E');
  if (word == nullptr) return 0;
  const double value = length_of(block, *word, unit);
  const double before = reading_;
  reading_ = counts_on ? before + value : value;
  if (std::abs(reading_) > kLargestExtruder)
    block.fail(*word, fmt::format("'{}' leads to {:.6g} mm of filament, beyond {:.6g} mm", word->text,
                                  to_mm(reading_), to_mm(kLargestExtruder)));
  const double most_before = most_fed_;
  const double fed = count_fed(flow_ * (counts_on ? value : value - before));
  if (!counts_on && block.find_any("XY") != nullptr)
    count_absolute(block.line(), value, before, most_fed_ > most_before);
  return fed;
}

void GcodeExtruder::rename(Block& block, double unit) {
  if (const Word* word = block.take('E')) reading_ = length_of(block, *word, unit);
}

void GcodeExtruder::set_retraction(Block& block, double unit) {
  const Word* command = block.find(Command::retraction);
  if (command == nullptr) return;
  const Word *s = block.take('S'), *f = block.take('F');
  block.extract('Z');  // a hop that the slicer adds to its own moves
  if (s == nullptr || f == nullptr)
    block.fail(*command,
               fmt::format("'{}' needs S, the length in mm, and F, the feed in mm/min", command->text));
  const double length = length_of(block, *s, unit), feed = f->value * unit / 60;
  if (length < 0 || length > kLongestRetraction)
    block.fail(*s,
               fmt::format("'{}': the length is outside 0 to {:g} mm", s->text, to_mm(kLongestRetraction)));
  if (!(feed > 0)) block.fail(*f, fmt::format("'{}': the feed must be above 0", f->text));
  retraction_ = length;
  retraction_feed_ = feed;
}

FedAtRest GcodeExtruder::retract(Block& block) {
  const bool back = block.find(Command::unretract) != nullptr;
  const Word& code = *block.find(back ? Command::unretract : Command::retract);
  if (!block.alone(code))
    block.fail(code, fmt::format("'{}' is alone on its line, or G10 L2 sets a work offset", code.text));
  if (!retraction_)
    block.fail(code, fmt::format("'{}' retracts by a length that the program does not say: "
                                 "add M207 with S (mm) and F (mm/min) before it",
                                 code.text));
  if (back != retracted_) return {};  // a second one does nothing
  retracted_ = !back;
  return {count_fed((back ? 1 : -1) * *retraction_), *retraction_ / retraction_feed_};
}

void GcodeExtruder::select(Block& block) {
  const Word* tool = block.find('T');
  if (tool == nullptr) return;
  const bool of_command = block.find(Command::heat) != nullptr ||
                          block.find(Command::heat_and_wait) != nullptr ||
                          block.find(Command::flow) != nullptr || block.find(Command::tool_change) != nullptr;
  if (!of_command && !block.alone(*tool)) return;
  block.take('T');
  if (tool->value >= kNoTool) return;
  if (tool->value != 0 && tool->value != 1)
    block.fail(*tool, fmt::format("'{}': the machine has one extruder, T0 or T1", tool->text));
  if (tool_ && *tool_ != tool->value)
    block.fail(*tool, fmt::format("'{}' after T{}: the machine has one extruder", tool->text, *tool_));
  tool_ = tool->value;
}

void GcodeExtruder::count_absolute(int line, double value, double before, bool fresh) {
  if (tally_.moves++ == 0) tally_.first_line = line;
  if (fresh) ++tally_.fresh;
  if (value <= before) ++tally_.not_rising;
  tally_.by_words += std::max(0.0, value);
}

double GcodeExtruder::count_fed(double filament) {
  fed_ += filament;
  most_fed_ = std::max(most_fed_, fed_);
  return filament;
}

}  // namespace understudy::toolpath
