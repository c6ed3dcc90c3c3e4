// Frames of struts from JSON files.
#pragma once

#include <filesystem>
#include <string>

#include "toolpath/lattice/lattice.h"

namespace understudy::toolpath {

/// The `node_list` (`point` X Y Z, `is_grounded`, optional `node_id`) and `element_list` (`end_node_ids`) of
/// a frame in the form of the assembly_instances collection, lengths in its `unit`: millimeter, centimeter,
/// meter or inch. Other keys are the designer's (sections, loads) and say nothing about the print. Throws
/// InputError naming file and element for text that is not JSON, keys that are missing or of the wrong type,
/// an unknown unit, coordinates not finite, a node id given twice or not there, an element without length or
/// given twice, no grounded node, or a part of the frame that no strut connects to one.
Lattice read_lattice(const std::filesystem::path& path);
Lattice parse_lattice(const std::string& text, const std::string& file);

}  // namespace understudy::toolpath
