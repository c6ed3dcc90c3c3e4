// Curves of two rehearsals over each other, as SVG text.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/record.h"

namespace understudy::report {

enum class ComparedCurve { gap, tip_error };
enum class CurveAlong { time, path };

/// Both while they extrude, A dashed below B. A value that few reach stands at the edge of the scale. Empty
/// where neither extrudes over anything.
std::string comparison_chart(const std::vector<rehearsal::TracePoint>& a,
                             const std::vector<rehearsal::TracePoint>& b, ComparedCurve curve,
                             CurveAlong along);

/// A piece of the line of A or B, for a legend.
std::string comparison_key(bool of_a);

}  // namespace understudy::report
