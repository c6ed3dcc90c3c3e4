// The other way round: from a pose to what the words of its line read.
#include "toolpath/gcode/gcode_position.h"

namespace understudy::toolpath {

PlaceReading GcodePosition::reading_at(const Pose& X_WT, const std::optional<RotaryTurns>& turns, double unit,
                                       bool relative, bool in_machine) const {
  GcodePosition there = *this;
  if (turns) there.turns_ = turns;
  const Vec3 programmed = there.programmed_at(X_WT);
  const Vec3 from = in_machine ? shift() : relative ? programmed_ : origin_;
  PlaceReading reading;
  reading.xyz = (programmed - from) / unit;
  if (!turns) return reading;
  const RotaryTurns before = in_machine ? RotaryTurns{}
                             : relative ? turns_.value_or(RotaryTurns{})
                                        : turns_origin_;
  const auto words = options_->rotary ? options_->rotary->letters.size() : 0;
  if (words > 0) reading.turns.b = (turns->b - before.b) / turn_unit(0);
  if (words > 1) reading.turns.c = (turns->c - before.c) / turn_unit(1);
  return reading;
}

}  // namespace understudy::toolpath
