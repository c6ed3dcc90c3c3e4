// Refusals that the planners share. Each throws InputError naming quantity, value and limit.
#pragma once

#include <string>

#include "core/frames.h"

namespace understudy::toolpath {

/// `value` in `unit`, as the message shows it.
void check_positive(const char* name, double value, const char* unit);
void check_within(const char* name, double value, double lowest, double highest, const char* unit);
/// [m]: a flattened bead is at least as wide as high.
void check_bead(double width, double height);
/// [K], 0 leaves the heater alone; 0..1.
void check_nozzle(double temperature, double fan);

/// The number of steps that make `length`, both in one unit: at least 1. Throws InputError for more than
/// 10 000 000, which smell of a wrong unit.
int step_count(double length, double step);

/// "(1.000, 2.000, 3.000) mm"
std::string in_mm(const Vec3& p);

}  // namespace understudy::toolpath
