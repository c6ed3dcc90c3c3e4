#version 450 core
layout(location = 0) in vec3 position;  // world axes, about the scene's centre [m]
layout(location = 1) in vec3 normal;    // zero: drawn in its plain colour
layout(location = 2) in vec3 colour;    // linear RGB; red below zero: the ground
uniform mat4 clip;
out vec3 place;
out vec3 direction;
out vec3 albedo;
void main() {
  place = position;
  direction = normal;
  albedo = colour;
  gl_Position = clip * vec4(position, 1.0);
}
