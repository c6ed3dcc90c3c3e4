#include "toolpath/gcode/gcode_saved_state.h"

#include <charconv>
#include <map>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/gcode/gcode_state.h"
#include "toolpath/gcode/macros/gcode_macros.h"
#include "toolpath/gcode/words/gcode_words.h"

namespace understudy::toolpath {
namespace {

constexpr double kFastest = 1e5;  // [mm/s]

double number_up_to_fastest(const std::string& key, const std::string& text, const Place& place) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= kFastest))
    throw InputError(place, fmt::format("{}: a number from 0 to {:g} is needed", key, kFastest));
  return value;
}

}  // namespace

std::optional<SavedStateCall> saved_state_call(std::string_view line, const Place& place) {
  const std::string command = command_in_words(line);
  const bool save = command == "SAVE_GCODE_STATE";
  if (!save && command != "RESTORE_GCODE_STATE") return std::nullopt;
  auto parameters = call_parameters(command, line, place);
  SavedStateCall call;
  call.save = save;
  call.name = parameters.contains("NAME") ? parameters["NAME"] : "default";
  if (save) return call;
  if (parameters.contains("MOVE")) call.back = number_up_to_fastest("MOVE", parameters["MOVE"], place) != 0;
  if (!parameters.contains("MOVE_SPEED")) return call;
  call.speed = from_mm(number_up_to_fastest("MOVE_SPEED", parameters["MOVE_SPEED"], place));
  if (*call.speed <= 0) throw InputError(place, "MOVE_SPEED must be above 0 mm/s");
  return call;
}

void GcodeState::save(const std::string& name) {
  saved_.insert_or_assign(name, Saved{position_, extruder_, speed_, relative_, feed_});
}

void GcodeState::restore(const std::string& name, bool back, const std::optional<double>& speed,
                         const Place& place, std::vector<Step>& steps) {
  constexpr double kFirstFeed = 0.025;  // [m/s], of Klipper before any F
  const auto found = saved_.find(name);
  if (found == saved_.end())
    throw InputError(place, fmt::format("no SAVE_GCODE_STATE before it has the name '{}'", name));
  const Saved& saved = found->second;
  relative_ = saved.relative;
  speed_ = saved.speed;
  feed_ = saved.feed;
  extruder_.take_saved(saved.extruder);
  position_.take_shifts(saved.position);
  if (!back) return;
  if (!position_.go_back_to(saved.position))
    throw InputError(place, "MOVE=1 on a machine with rotary words: write out where it goes");
  steps.push_back(step(StepKind::move, place.line));
  steps.back().feed = speed ? *speed : speed_ * feed_.value_or(kFirstFeed);
}

}  // namespace understudy::toolpath
