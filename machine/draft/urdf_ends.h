// Which links of a URDF carry the work and the tool, where nobody says so.
#pragma once

#include <filesystem>
#include <string>

namespace understudy::machine {

struct UrdfEnds {
  std::string base, tool;
};

/// The root, and a link with a usual name of a flange or a tool; else the last link of the arm before it
/// forks into fingers. Throws InputError as parse_urdf(), and where no joint moves.
UrdfEnds likely_ends(const std::filesystem::path& urdf);

}  // namespace understudy::machine
