// The program of a request, read as the machine and the request say.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "machine/description.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/request/request.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/inspection/feature_types.h"
#include "toolpath/inspection/told_beads.h"

namespace understudy::rehearsal {

struct ReadProgram {
  toolpath::Program program;
  bool of_robot = false;                          ///< KRL or RAPID
  std::vector<toolpath::PassedOver> passed_over;  ///< none where the request is strict
  std::map<std::string, std::string> facts;       ///< of the slicer's comments (toolpath::slicer_facts)
  toolpath::FeatureTypes features;                ///< of the slicer's comments
  toolpath::ToldBeads beads;                      ///< of the slicer's comments
  int start_block_end = 0;                        ///< line, by the slicer's comments (start_block.h)
  std::vector<Finding> extrusion;  ///< where E is misread, or feeds another amount than a comment tells
};

/// With the temperature that the request asks for ahead of it. Throws InputError as read_gcode() and
/// read_robot_program() do, with the command that says more where words mean nothing to this machine; of a
/// strict request with all lines that cannot be read.
ReadProgram read_program(const RehearsalRequest& request, const machine::MachineDescription& machine);

/// A finding for each line that was passed over: an error.
std::vector<Finding> findings_of(const std::vector<toolpath::PassedOver>& lines);

/// A finding where its rotary words are for another kind of machine (readings.h).
std::optional<Finding> misread_words(const RehearsalRequest& request, const toolpath::Program& program,
                                     const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal
