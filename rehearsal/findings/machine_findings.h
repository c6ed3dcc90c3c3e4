// What a machine's own file says stands behind an answer: figures that nobody measured, links without shapes.
#pragma once

#include <vector>

#include "machine/machine_notes.h"
#include "rehearsal/findings/finding.h"

namespace understudy::rehearsal {

/// Warnings. Kind "assumption" lists every group of assumed figures with what depends on it; its value is
/// their number. Kind "unchecked" names the links whose collision shapes are left out, and counts them.
std::vector<Finding> machine_findings(const machine::MachineNotes& notes);

}  // namespace understudy::rehearsal
