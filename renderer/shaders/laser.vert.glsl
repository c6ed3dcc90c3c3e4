#version 450 core
// Camera coordinates [m], computed in double on the CPU.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 facet;  // unit normal n and n . p of the triangle's plane
layout(location = 3) in float owner;

uniform vec4 lens;     // focal length, centre x, centre y [px of the target]
uniform vec2 size;     // [px of the target]
uniform vec2 near_far; // [m]

out vec3 shading_normal;
flat out vec4 plane;
flat out float surface_owner;

void main() {
  shading_normal = normal;
  plane = facet;
  surface_owner = owner;
  // Row 0 of the target is the top of the picture.
  float x = 2.0 / size.x * (lens.x * position.x + lens.y * position.z) - position.z;
  float y = 2.0 / size.y * (lens.x * position.y + lens.z * position.z) - position.z;
  float n = near_far.x, f = near_far.y;
  float z = (f + n) / (f - n) * position.z - 2.0 * f * n / (f - n);
  gl_Position = vec4(x, y, z, position.z);
}
