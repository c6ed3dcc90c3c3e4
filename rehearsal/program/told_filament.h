// The filament that a program feeds, beside what the slicer's comment says.
#pragma once

#include <optional>
#include <string>

#include "rehearsal/findings/finding.h"
#include "toolpath/gcode/gcode_extrusion.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// [m] fed; what a retraction took back counts once.
double fresh_filament(const toolpath::Program& program);

/// An error where E is read as absolute and looks relative, so that next to nothing is fed of what the moves
/// say. `told` [m]: by the comment.
std::optional<Finding> misread_extrusion(const toolpath::ExtrusionTally& tally, double fed,
                                         const std::optional<double>& told);

/// What `inspect` says of such a program.
std::string relative_look(const toolpath::ExtrusionTally& tally);

/// A warning where the amount is another than the comment's by a fifth, and by what start lines purge; an
/// error where it is less than a quarter.
std::optional<Finding> other_amount(double fed, const std::optional<double>& told);

}  // namespace understudy::rehearsal
