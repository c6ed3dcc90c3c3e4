#version 450 core
// Light from the sky and the lamp, at half the picture's size: it varies slowly and costs most. Each pixel once: llvmpipe
// shades at least 16 pixels of a triangle, and most triangles are smaller.
const int kSky = 48;

uniform sampler2D surface;         // distance from the eye [m], normal
uniform vec2 size;                 // of `surface` [px]
uniform vec3 eye;
uniform vec3 ahead, across, upward;  // from the eye to the middle of the picture; from there to its right and upper edge
uniform vec3 sky_direction[kSky];  // towards the lights
uniform mat4 sky_clip[kSky];
uniform ivec2 sky_tiles;           // columns and rows of the atlas
uniform float sky_texel;           // [m]
uniform sampler2DShadow sky_atlas;
uniform mat4 lamp_clip;
uniform float lamp_texel;          // [m]
uniform sampler2DShadow lamp_depth;

// light (see packed_light), distance from the eye [m], two coordinates of the normal
layout(location = 0) out vec4 result;

// Irradiance from an even sky, 1 for an open surface that faces up.
float sky(vec3 place, vec3 n) {
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

// The share of the lamp that is seen from there.
float lamp(vec3 place, vec3 n) {
  vec3 at = 0.5 * (lamp_clip * vec4(place + 2.0 * lamp_texel * n, 1.0)).xyz + 0.5;
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;
  vec2 step_size = 2.5 / vec2(textureSize(lamp_depth, 0));
  float sum = 0.0;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      sum += textureLod(lamp_depth, vec3(at.xy + vec2(i, j) * step_size, min(at.z, 1.0)), 0.0);
    }
  }
  return sum / 9.0;
}

// Both in one number: the sky in whole 1/1024, and the lamp as the fraction.
float packed_light(float sky, float lamp) { return floor(1024.0 * sky) + 0.998 * lamp; }

void main() {
  vec4 seen = texelFetch(surface, ivec2(gl_FragCoord.xy), 0);
  vec3 n = seen.yzw;
  if (seen.x > 1e8) {
    result = vec4(packed_light(1.0, 1.0), seen.x, n.xy);
    return;
  }
  vec2 at = 2.0 * gl_FragCoord.xy / size - 1.0;
  vec3 place = eye + seen.x * normalize(ahead + at.x * across + at.y * upward);
  result = vec4(packed_light(sky(place, n), lamp(place, n)), seen.x, n.xy);
}
