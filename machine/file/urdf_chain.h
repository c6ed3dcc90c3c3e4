// Arms from URDF files: kinematics, ranges, masses.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "geometry/shape.h"
#include "kinematics/chain/chain.h"

namespace understudy::machine {

/// A rigid part, seen from O while all axes are 0.
struct LinkMass {
  std::string name;
  int axis = -1;                  ///< that carries it; -1: the frame
  double mass = 0;                ///< [kg]
  Vec3 centre_O = Vec3::Zero();   ///< [m], centre of mass
  Mat3 inertia_O = Mat3::Zero();  ///< [kg m^2], about that centre, along the axes of O
};

/// Of one axis; infinite where nothing is said. A 0 in the file means the same, as is the custom.
struct AxisDrive {
  double velocity_max = kinematics::kEndless;  ///< [rad/s] or [m/s]
  double effort_max = kinematics::kEndless;    ///< [N m] or [N]
};

/// A file of a collision shape as the URDF names it: "package://ur/meshes/base.stl".
struct UrdfMesh {
  std::string file;
  Vec3 scale{1, 1, 1};
};

/// A `<collision>` of a link.
struct UrdfShape {
  std::string link;
  int axis = -1;  ///< that carries it; -1: the frame
  std::variant<geometry::Box, geometry::Cylinder, geometry::Sphere, UrdfMesh> form;
  Pose X_OS = Pose::Identity();  ///< all axes at 0; the shape's origin is its centre
};

struct UrdfArm {
  /// O is the frame of the file's root link; S that of `base_link`, T that of `tool_link`. Axes from the base
  /// to the tool, named as the joints; where the base moves too, its axes come last.
  kinematics::Chain chain;
  std::vector<LinkMass> links;          ///< all that have mass and are carried by the chain or its frame
  std::vector<AxisDrive> drives;        ///< one an axis
  std::vector<UrdfShape> shapes;        ///< of all links, in the order of the tree
  std::vector<std::string> link_names;  ///< of all links, sorted
};

/// Joints beside the way from base to tool are held at 0, where their links are carried along. Throws
/// InputError naming file, element and value for what is no URDF, unknown links, loops, joints that are
/// planar, floating or mimic others on the way, axes without direction, empty ranges, impossible masses and
/// shapes, and more axes than kMaxAxes.
UrdfArm read_urdf(const std::filesystem::path& file, const std::string& base_link,
                  const std::string& tool_link);

}  // namespace understudy::machine
