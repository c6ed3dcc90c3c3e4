#version 450 core
// Centroids: at a silhouette the pixel's centre lies off the triangle.
centroid in vec3 place;
centroid in vec3 direction;
centroid in vec3 albedo;

uniform vec3 eye;
uniform vec3 background;
uniform float ground_fade;             // [m], where the ground has become background
uniform sampler2D half_size_light;     // of light.frag
uniform vec3 lamp_direction;

layout(location = 0) out vec4 result;

vec3 encoded(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

// Of sky and lamp, from the half-size picture: the four nearest points, as far as they lie on the same surface.
vec2 light(vec3 n) {
  vec2 at = gl_FragCoord.xy / 2.0 - 0.5;
  vec2 part = fract(at);
  float far = distance(eye, place), weights = 0.0;
  vec2 sum = vec2(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec4 s = texelFetch(half_size_light, clamp(ivec2(floor(at)) + corner, ivec2(0), textureSize(half_size_light, 0) - 1), 0);
    vec2 near = mix(1.0 - part, part, vec2(corner));
    float off = abs(s.y - far) / (0.01 * far);
    vec2 turned = s.zw - n.xy;
    float weight = near.x * near.y * exp(-off * off - 20.0 * dot(turned, turned)) + 1e-6 * exp(-off);
    sum += weight * vec2(floor(s.x) / 1024.0, fract(s.x) / 0.998);
    weights += weight;
  }
  return weights > 1e-12 ? sum / weights : vec2(0.5, 1.0);
}

void main() {
  if (albedo.r < 0.0) {
    float open = dot(vec2(0.75, 0.25), light(vec3(0.0, 0.0, 1.0)));
    float fade = smoothstep(1.0, 0.4, length(place.xy) / ground_fade);
    result = vec4(encoded(background * mix(1.0, min(1.0, open), 0.8 * fade)), 1.0);
    return;
  }
  if (dot(direction, direction) < 0.25) {
    result = vec4(encoded(albedo), 1.0);
    return;
  }
  vec3 view = normalize(eye - place);
  vec3 n = normalize(direction);
  if (dot(n, view) < 0.0) n = -n;
  vec2 lit = light(n);
  float key = max(0.0, dot(n, lamp_direction)) * lit.y;
  float bounce = 0.5 - 0.5 * n.z;
  float diffuse = 0.56 * lit.x + 0.42 * key + 0.16 * bounce + 0.08 * max(0.0, dot(n, view));
  vec3 half_way = normalize(view + lamp_direction);
  float gloss = 0.10 * pow(max(0.0, dot(n, half_way)), 40.0) * step(0.001, key);
  result = vec4(encoded(albedo * diffuse + gloss), 1.0);
}
