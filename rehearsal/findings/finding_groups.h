// Findings as people read them: alike ones as one, causes ahead of what comes of them, with advice.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// Findings of one kind, severity and subject.
struct FindingGroup {
  Finding worst;  ///< farthest beyond its limit; it speaks for all
  int count = 1;
  int first_line = 0, last_line = 0;  ///< from where to where in the program; 0: no line
  std::string advice;                 ///< what to do about it
};

/// Errors first; of these what breaks, stops or misleads the machine ahead of what comes of it on the part
/// (the program itself, limits, stops, contacts and tip errors, gap, flow, adhesion, sag); then by line.
std::vector<FindingGroup> group_findings(const Record& record);

/// "line 7"; "lines 7 to 80, 21 times"; empty without a line.
std::string extent_of(const FindingGroup& group);

}  // namespace understudy::rehearsal
