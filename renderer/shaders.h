// Shader sources, embedded from shaders/*.glsl by CMake.
#pragma once

#include <string>

namespace understudy::renderer {

/// "laser.vert" for shaders/laser.vert.glsl.
std::string shader_source(const std::string& name);

}  // namespace understudy::renderer
