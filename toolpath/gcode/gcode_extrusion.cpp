#include "toolpath/gcode/gcode_extrusion.h"

namespace understudy::toolpath {
namespace {

constexpr int kFewestMoves = 5;          // by which a habit shows
constexpr double kFewFresh = 0.2;        // of the moves; of sliced programs with absolute E 60 % and more are
constexpr double kOftenNotRising = 0.2;  // of the moves; about half of relative words are below the last

}  // namespace

bool ExtrusionTally::looks_relative() const {
  return moves >= kFewestMoves && by_words > 0 && fresh < kFewFresh * moves &&
         not_rising > kOftenNotRising * moves;
}

}  // namespace understudy::toolpath
