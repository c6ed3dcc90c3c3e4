#version 450 core
// Coordinates across and along the beam [m].
layout(location = 0) in vec3 position;
uniform float reach;      // half the width of the map [m]
uniform vec2 near_far;    // [m]
out float along;
void main() {
  along = position.z;
  float depth = 2.0 * (position.z - near_far.x) / (near_far.y - near_far.x) - 1.0;
  gl_Position = vec4(position.xy / reach, depth, 1.0);
}
