#version 450 core
// At half the picture's size: light from the sky varies slowly and costs most.
const int kSky = 48;
in vec3 place;
in vec3 direction;
in vec3 albedo;

uniform vec3 eye;
uniform vec3 sky_direction[kSky];  // towards the lights
uniform mat4 sky_clip[kSky];
uniform ivec2 sky_tiles;           // columns and rows of the atlas
uniform float sky_texel;           // [m]
uniform sampler2DShadow sky_atlas;

// irradiance, distance from the eye [m], two coordinates of the normal
layout(location = 0) out vec4 result;

// Irradiance from an even sky, 1 for an open surface that faces up.
float sky(vec3 n) {
  vec4 p = vec4(place + 1.5 * sky_texel * n, 1.0);
  float sum = 0.0;
  for (int i = 0; i < kSky; ++i) {
    float cosine = max(0.0, dot(n, sky_direction[i]));
    vec3 at = 0.5 * (sky_clip[i] * p).xyz + 0.5;
    vec2 tile = vec2(i % sky_tiles.x, i / sky_tiles.x);
    float open = textureLod(sky_atlas, vec3((tile + clamp(at.xy, 0.004, 0.996)) / vec2(sky_tiles), min(at.z, 1.0)), 0.0);
    bool beside = any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)));
    sum += cosine * (beside ? 1.0 : open);
  }
  return 2.0 * sum / float(kSky);
}

void main() {
  vec3 n = normalize(direction);
  if (dot(n, eye - place) < 0.0) n = -n;
  result = vec4(sky(n), distance(eye, place), n.xy);
}
