// A URDF file as urdfdom's tree of links. Only sources of this folder see it.
#pragma once

#include <filesystem>

#include <urdf_model/model.h>
#include <urdf_world/types.h>

namespace understudy::machine {

/// One tree of links. Throws InputError naming the file for what is no URDF or too large (docs/limits.md), an
/// unexpanded xacro file, a joint of a range without one, loops, and links apart from the tree.
urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file);

/// Throws InputError, and names the nearest link, where there is none of that name.
urdf::LinkConstSharedPtr find_link(const urdf::ModelInterface& model, const std::string& file,
                                   const std::string& name);

}  // namespace understudy::machine
