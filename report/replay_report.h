// A record that was replayed on the twin (docs/identify.md): what is printed, replay.json and replay.csv.
#pragma once

#include <string>

#include "rehearsal/replayed_record.h"

namespace understudy::report {

/// Of a slide or strut [m] in um, of a turn [rad] in arcmin.
double shown_difference(double difference, bool angle);
const char* difference_unit(bool angle);

std::string replay_text(const rehearsal::ReplayedRecord& replay);
/// Schema "understudy.replay/1".
std::string replay_json(const rehearsal::ReplayedRecord& replay);
/// A row a measurement: side (drive or load), time, line, and of each axis machine and twin in mm or deg.
std::string replay_csv(const rehearsal::ReplayedRecord& replay);

}  // namespace understudy::report
