// A pose as two keys of a section of the machine file: BODY_mm and BODY_quaternion.
#pragma once

#include <string>

#include "core/frames.h"
#include "core/yaml/yaml_map.h"

namespace understudy::machine {

/// Throws InputError for a quaternion that is not of unit length. The identity where a key is missing.
/// `where` says what frame it is told in.
Pose read_mount(YamlMap& map, const std::string& body, const std::string& where);

/// Both keys, to a nanometre and 1e-12: below every machine, so that the file loses nothing.
std::string mount_text(const std::string& body, const Pose& X);

/// "[x, y, z]" in nine decimals of `unit`.
std::string vector_text(const Vec3& v, double unit);

}  // namespace understudy::machine
