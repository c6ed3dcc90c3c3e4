// The collision shapes of a URDF as bodies that clearances are measured with.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/shape.h"
#include "machine/file/urdf_chain.h"

namespace understudy::machine {

struct UrdfBody {
  std::string link;
  int axis = -1;
  geometry::Shape shape;  ///< named as the link; "forearm 2" where it is not the first of its link. X_FS in O
};

/// Where mesh files lie.
struct MeshPlaces {
  std::filesystem::path urdf;      ///< paths without a scheme are relative to its folder
  std::filesystem::path packages;  ///< `package://NAME/PATH` is NAME/PATH or PATH in here
};

/// Every place where the mesh may lie, the likeliest first; of a package, also a folder of its name above the
/// URDF.
std::vector<std::filesystem::path> mesh_places(const std::string& named, const MeshPlaces& places);
/// The first of them that is a file; empty where none is.
std::filesystem::path find_mesh(const std::string& named, const MeshPlaces& places);

/// Boxes, cylinders and spheres as they are, meshes as their convex hulls. The shapes of the links in
/// `left_out` are passed over. `files`: the meshes that were read, which must lie in `folder` or below,
/// unless the user allows others (core/file/outside.h). Throws InputError naming the URDF, link and mesh for
/// one that does not, is missing, is no mesh, or is flat.
std::vector<UrdfBody> urdf_bodies(const UrdfArm& arm, const MeshPlaces& places,
                                  const std::filesystem::path& folder,
                                  const std::vector<std::string>& left_out,
                                  std::vector<std::filesystem::path>& files);

/// The pairs of `<disable_collisions>`, by links of the URDF. Throws InputError naming file and value for
/// what is no SRDF, and for links that the URDF has not.
std::vector<std::array<std::string, 2>> read_srdf(const std::filesystem::path& file,
                                                  const std::vector<std::string>& links);

}  // namespace understudy::machine
