// SAVE_GCODE_STATE and RESTORE_GCODE_STATE, as Klipper has them ("G-Codes", gcode_move).
#include <fmt/format.h>

#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {

void GcodeState::save(const std::string& name) {
  saved_.insert_or_assign(name,
                          Saved{position_, extruder_, flow_, speed_, relative_, relative_extrusion_, feed_});
}

void GcodeState::restore(const std::string& name, bool back, const std::optional<double>& speed,
                         const Place& place, std::vector<Step>& steps) {
  constexpr double kFirstFeed = 0.025;  // [m/s], of Klipper before any F
  const auto found = saved_.find(name);
  if (found == saved_.end())
    throw InputError(place, fmt::format("no SAVE_GCODE_STATE before it has the name '{}'", name));
  const Saved& saved = found->second;
  relative_ = saved.relative;
  relative_extrusion_ = saved.relative_extrusion;
  flow_ = saved.flow;
  speed_ = saved.speed;
  feed_ = saved.feed;
  extruder_ = saved.extruder;
  position_.take_shifts(saved.position);
  if (!back) return;
  if (!position_.go_back_to(saved.position))
    throw InputError(place, "MOVE=1 on a machine with rotary words: write out where it goes");
  steps.push_back(step(StepKind::move, place.line));
  steps.back().feed = speed ? *speed : speed_ * feed_.value_or(kFirstFeed);
}

}  // namespace understudy::toolpath
