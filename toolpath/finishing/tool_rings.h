// The bodies of a milling tool as rings about its axis.
#pragma once

#include <string>
#include <vector>

#include "geometry/shape.h"

namespace understudy::toolpath {

struct ToolRing {
  std::string name;
  double radius = 0;        ///< [m], of the cylinder about the tool's axis that holds the body
  double from = 0, to = 0;  ///< [m], along the axis from the tip
};

/// Each body in T as a ring, without the mill: bodies that begin at the tip and are no wider than it.
std::vector<ToolRing> tool_rings(const std::vector<geometry::Shape>& bodies, double mill_radius);

}  // namespace understudy::toolpath
