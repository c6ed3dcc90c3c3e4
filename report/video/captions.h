// What is written below a frame of a film.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/findings/finding_groups.h"

namespace understudy::report {

struct Caption {
  std::string text;  ///< ASCII, as OpenCV's strokes need it
  bool error = false;
};

/// Of the findings whose instants are no more than `shown_for` [s of the run] ago, the latest first; two at
/// most. What holds from the begin has the instant 0.
std::vector<Caption> captions_at(const std::vector<rehearsal::FindingGroup>& findings, double time,
                                 double shown_for);

/// With what ASCII has in place of signs that it has not: "um", "deg", "x"; "?" for the rest.
std::string in_ascii(const std::string& text);

}  // namespace understudy::report
