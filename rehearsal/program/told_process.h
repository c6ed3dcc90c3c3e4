// Nozzle and layers as an option or the slicer's comments tell them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "machine/description.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/request/request.h"
#include "toolpath/inspection/told_beads.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// The number that a slicer's comment begins with, of toolpath::slicer_facts(); several extruders are a list.
std::optional<double> fact_number(const std::map<std::string, std::string>& facts, const std::string& key);

/// A nozzle of this bore [m] takes the place of the described one: the flat around it is as wide as before.
void mount_nozzle(machine::Tool& tool, double bore);

/// [m], of the request or the comments; 0: neither tells.
double told_layer(const DialectRequest& dialect, const std::map<std::string, std::string>& facts);

/// [mm] of the filament that the slicer worked for, where the tool has another.
std::optional<double> other_filament(const machine::Tool& tool,
                                     const std::map<std::string, std::string>& facts);

/// The material that the slicer's comments name, as the materials of models/ are called: "abs" of "ABS;ABS";
/// empty: they name none.
std::string told_material(const std::map<std::string, std::string>& facts);

/// A warning: the slicer worked for another material than the one of this name.
std::optional<Finding> other_material(const std::string& material,
                                      const std::map<std::string, std::string>& facts);

/// Warnings: the slicer worked for another nozzle or filament than what is there; the request's layer is not
/// the one [m] that most of the path has (0: none).
std::vector<Finding> process_warnings(const DialectRequest& dialect, const machine::Tool& tool,
                                      const std::map<std::string, std::string>& facts, double typical_layer);

/// A warning: over most of the path whose beads comments tell, the program feeds another amount of filament.
std::optional<Finding> other_flow(const toolpath::Program& program,
                                  const machine::MachineDescription& machine,
                                  const toolpath::ToldBeads& beads);

}  // namespace understudy::rehearsal
