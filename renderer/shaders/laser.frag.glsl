#version 450 core
in vec3 shading_normal;
flat in vec4 plane;
flat in float surface_owner;

uniform vec4 lens;           // focal length, centre x, centre y [px of the target]
uniform vec3 axis_point;     // on the beam's axis, camera coordinates [m]
uniform mat3 beam;           // columns: two axes across the beam and its direction, camera coordinates
uniform float radius;        // of the beam, 1/e^2 [m]
uniform float reach;         // half the width of the shadow map [m]
uniform float peak;          // [grey levels]
uniform float ambient;       // [grey levels]
uniform float tool_albedo;
uniform sampler2D blockers;  // first surface along the beam, from axis_point [m]

// laser [grey levels], ambient [grey levels], depth [m], owner
layout(location = 0) out vec4 result;

float lit(vec3 offset, float slope_cosine) {
  vec2 across = vec2(dot(offset, beam[0]), dot(offset, beam[1]));
  vec2 cells = vec2(textureSize(blockers, 0));
  ivec2 cell = ivec2(floor((across / reach * 0.5 + 0.5) * cells));
  float first = texelFetch(blockers, clamp(cell, ivec2(0), ivec2(cells) - 1), 0).r;
  // A cell holds one depth of a surface that slopes across it.
  float slope = sqrt(max(0.0, 1.0 - slope_cosine * slope_cosine)) / slope_cosine;
  float margin = 10e-6 + 2.0 * reach / cells.x * slope;
  return dot(offset, beam[2]) <= first + margin ? 1.0 : 0.0;
}

void main() {
  // The pixel's ray met with the triangle's plane: exact for triangles of any size.
  vec3 ray = vec3((gl_FragCoord.xy - lens.yz) / lens.x, 1.0);
  float facing = dot(plane.xyz, ray);
  if (abs(facing) < 1e-5) discard;  // edge-on
  vec3 p = ray * (plane.w / facing);
  // The side that is seen is the side that is lit, of open surfaces too.
  float side = facing > 0.0 ? -1.0 : 1.0;
  vec3 n = side * normalize(shading_normal);
  float albedo = surface_owner > 1.5 ? tool_albedo : 1.0;

  vec3 offset = p - axis_point;
  float distance = length(cross(offset, beam[2])) / radius;
  float laser = 0.0;
  float facet_cosine = -side * dot(plane.xyz, beam[2]);
  if (distance * radius < reach && facet_cosine > 1e-3) {
    float shade = max(0.0, -dot(n, beam[2])) * exp(-2.0 * distance * distance);
    laser = peak * albedo * shade * lit(offset, facet_cosine);
  }
  // A ring light around the lens, over even room light.
  float ring = max(0.0, -dot(n, normalize(ray)));
  result = vec4(laser, ambient * albedo * (0.3 + 0.7 * ring), p.z, surface_owner);
}
