// Frames of struts: read from a file, or a cubic lattice that fills a part (Ishak 2018).
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

struct LatticeNode {
  Vec3 position;          ///< [m]
  bool grounded = false;  ///< stands on the table from the start
};

struct Lattice {
  std::vector<LatticeNode> nodes;
  std::vector<std::array<int, 2>> struts;  ///< indices of two nodes

  double length(std::size_t strut) const;  ///< [m]
};

/// Struts that a cubic lattice can be printed with (Ishak 2018: the nozzle's clearance) [m].
constexpr double kShortestStrut = 5 * kMillimetre;
constexpr double kLongestStrut = 11 * kMillimetre;

/// The `node_list` (`point` X Y Z, `is_grounded`, optional `node_id`) and `element_list` (`end_node_ids`) of
/// a frame in the form of the assembly_instances collection, lengths in its `unit`: millimeter, centimeter,
/// meter or inch. Other keys are the designer's (sections, loads) and say nothing about the print. Throws
/// InputError naming file and element for text that is not JSON, keys that are missing or of the wrong type,
/// an unknown unit, coordinates not finite, a node id given twice or not there, an element without length or
/// given twice, no grounded node, or a part of the frame that no strut connects to one.
Lattice read_lattice(const std::filesystem::path& path);
Lattice parse_lattice(const std::string& text, const std::string& file);

/// A lattice of cubes of `strut`, and how many nodes within the part had no connection to the table.
struct LatticeFill {
  Lattice lattice;
  int dropped = 0;
};

/// Nodes on the grid of cubes that lie in the closed part or on it, struts where neighbours' middle does too;
/// as many cubes as fit, centred in x and y on the part's bounding box, from its lowest point upwards; the
/// lowest nodes are grounded. Throws InputError for a strut outside 5..11 mm, an open part, or a part without
/// room for one cube's strut.
LatticeFill fill_part(const geometry::Mesh& part, double strut);
/// The same for a box that stands on z = 0, centred in x and y.
LatticeFill fill_box(const Vec3& size, double strut);

/// Scales by `scale` about the origin, then shifts so that the middle of the bounding box's lower side comes
/// to `place` [m].
void place_lattice(Lattice& lattice, double scale, const Vec3& place);

/// Node indices that no strut connects to a grounded node, of those that struts use.
std::vector<int> hanging_nodes(const Lattice& lattice);

}  // namespace understudy::toolpath
