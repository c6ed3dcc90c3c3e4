// Where a program stands on a machine's table, as options of `rehearse` say it.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

struct ProgramPlace {
  double x_mm = 0, y_mm = 0, z_mm = 0;  ///< of the program's origin in W
  double turn_deg = 0, spin_deg = 0;    ///< of DialectRequest
  std::vector<double> home_axes;        ///< of RehearsalRequest: another posture of an arm; empty: the file's
};

/// The request at this place.
RehearsalRequest placed(RehearsalRequest request, const ProgramPlace& place);

/// "--place 12.5,-3,0 --turn 45"
std::string place_words(const ProgramPlace& place);

}  // namespace understudy::rehearsal
