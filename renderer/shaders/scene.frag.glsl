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

// sRGB to a third of a grey level: c^(5/12) in roots, which llvmpipe has in hardware, and logarithms it has not.
vec3 encoded(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  vec3 root = sqrt(c), fourth = sqrt(root), eighth = sqrt(fourth);
  vec3 curve = 0.662002687 * root + 0.684122060 * fourth - 0.323583601 * eighth - 0.0225411470 * c;
  return mix(12.92 * c, curve, step(0.0031308, c));
}

// Of sky and lamp, from the half-size picture: the four nearest points, as far as they lie on the same surface.
vec2 light(vec3 n, float far) {
  vec2 at = 0.5 * gl_FragCoord.xy - 0.5;
  ivec2 first = ivec2(floor(at)), last = textureSize(half_size_light, 0) - 1;
  vec2 part = at - vec2(first);
  float per_off = 100.0 / far, weights = 0.0;
  vec2 sum = vec2(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec4 s = texelFetch(half_size_light, clamp(first + corner, ivec2(0), last), 0);
    vec2 near = mix(1.0 - part, part, vec2(corner));
    float off = (s.y - far) * per_off;
    vec2 turned = s.zw - n.xy;
    float apart = 1.0 + 0.25 * (off * off + 20.0 * dot(turned, turned));
    apart *= apart;
    float weight = near.x * near.y / (apart * apart) + 1e-6 / (1.0 + off * off);
    sum += weight * vec2(floor(s.x) / 1024.0, fract(s.x) / 0.998);
    weights += weight;
  }
  return weights > 1e-12 ? sum / weights : vec2(0.5, 1.0);
}

// llvmpipe takes every way through an `if`, so each part is computed once for all of them.
void main() {
  bool is_ground = albedo.r < 0.0, is_plain = dot(direction, direction) < 0.25;
  vec3 view = eye - place;
  float far = length(view);
  view /= far;
  vec3 n = is_ground ? vec3(0.0, 0.0, 1.0) : normalize(direction);
  float facing = dot(n, view);
  if (facing < 0.0) n = -n;
  vec2 lit = light(n, far);
  float key = max(0.0, dot(n, lamp_direction)) * lit.y;
  float bounce = 0.5 - 0.5 * n.z;
  float diffuse = 0.56 * lit.x + 0.42 * key + 0.16 * bounce + 0.08 * abs(facing);
  vec3 half_way = view + lamp_direction;
  float shine = max(0.0, dot(n, half_way));
  shine *= shine / dot(half_way, half_way);  // the cosine to the 2, then to the 4, 8
  shine *= shine;
  shine *= shine;
  float gloss = 0.10 * shine * (shine * shine) * (shine * shine) * step(0.001, key);
  float fade = smoothstep(1.0, 0.4, length(place.xy) / ground_fade);
  vec3 ground = background * mix(1.0, min(1.0, dot(vec2(0.75, 0.25), lit)), 0.8 * fade);
  result = vec4(encoded(is_ground ? ground : is_plain ? albedo : albedo * diffuse + gloss), 1.0);
}
