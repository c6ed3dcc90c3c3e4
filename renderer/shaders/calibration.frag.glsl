#version 450 core
// One fragment is one pixel: the viewing ray, distortion removed, against a chessboard's plane or spheres.
uniform vec4 lens;       // focal length, centre x, centre y [px], blur [px]
uniform vec4 brown;      // k1, k2, p1, p2
uniform vec2 origin;     // pixel of the target's first fragment
uniform vec4 light;      // gain, ambient [grey levels], albedo of ink or spheres, of the background
uniform int spheres;     // how many; none: the board
uniform mat3 to_grid;    // ray to squares, homogeneous; (0, 0) is the outer corner of the first square
uniform vec3 sheet;      // squares in x and y, white margin [squares]
uniform mat3 to_sheet;   // directions of the camera to the sheet's: squares, squares, [m]
uniform vec3 bow;        // [m], the sheet's z by X^2, X Y and Y^2, which are 1 at the farthest corners
uniform vec3 centre[8];  // [m], farthest first
uniform float radius;    // [m]

out float level;

// Gauss points of a pixel: +-1 / (2 sqrt 3).
const float gauss = 0.28867513;

// Abramowitz and Stegun 7.1.26, 1.5e-7.
float erf_of(float x) {
  float a = abs(x);
  float t = 1.0 / (1.0 + 0.3275911 * a);
  float p = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  return sign(x) * (1.0 - p * exp(-a * a));
}

// Share of light of a Gaussian blur that comes from the positive side of an edge `sigmas` away.
float beyond(float sigmas) { return 0.5 + 0.5 * erf_of(0.70710678 * clamp(sigmas, -6.0, 6.0)); }

vec2 undistorted(vec2 seen) {
  vec2 ray = seen;
  for (int i = 0; i < 8; ++i) {
    float r2 = dot(ray, ray);
    vec2 tangential = vec2(2.0 * brown.z * ray.x * ray.y + brown.w * (r2 + 2.0 * ray.x * ray.x),
                           brown.z * (r2 + 2.0 * ray.y * ray.y) + 2.0 * brown.w * ray.x * ray.y);
    ray = (seen - tangential) / (1.0 + r2 * (brown.x + r2 * brown.y));
  }
  return ray;
}

// +1 and -1 from square to square along one axis, blurred; the last edges inside the board are continued.
float stripes(float t, float squares, float sigma) {
  float edge = clamp(round(t), 1.0, squares - 1.0);
  float side = mod(edge, 2.0) < 0.5 ? 1.0 : -1.0;
  float d = clamp((t - edge) / sigma, -6.0, 6.0);
  return side * erf_of(0.70710678 * d);
}

// Opposite sides are too far apart to blur into each other.
float inside(vec2 b, vec2 low, vec2 high, vec2 sigma) {
  vec2 depth = min(b - low, high - b) / sigma;
  return beyond(depth.x) * beyond(depth.y);
}

// Blur in squares: the gradient of the plane's coordinates over the picture.
vec2 blur_in_squares(vec3 h, vec2 b) {
  vec2 dx = (to_grid[0].xy - b * to_grid[0].z) / (h.z * lens.x);
  vec2 dy = (to_grid[1].xy - b * to_grid[1].z) / (h.z * lens.x);
  return max(lens.w * sqrt(dx * dx + dy * dy), vec2(1e-6));
}

// Where the ray meets the bowed sheet that it meets at b were it flat: along the ray by the sheet's depth, twice.
vec2 on_sheet(vec2 ray, vec2 b) {
  vec3 along = to_sheet * vec3(ray, 1.0);
  vec2 met = b;
  for (int i = 0; i < 2; ++i) {
    vec2 at = 2.0 * (met - 0.5 * sheet.xy) / (sheet.xy - 2.0);
    met = b + along.xy / along.z * dot(bow, vec3(at.x * at.x, at.x * at.y, at.y * at.y));
  }
  return met;
}

float board_light(vec2 ray) {
  vec3 h = to_grid * vec3(ray, 1.0);
  if (h.z <= 0.0) return light.w;
  vec2 b = on_sheet(ray, h.xy / h.z);
  vec2 sigma = blur_in_squares(h, b);
  float same = stripes(b.x, sheet.x, sigma.x) * stripes(b.y, sheet.y, sigma.y);
  float dark = 0.5 * (1.0 + same) * inside(b, vec2(0.0), sheet.xy, sigma);
  float paper = inside(b, vec2(-sheet.z), sheet.xy + sheet.z, sigma);
  return mix(light.w, 1.0 - dark * (1.0 - light.z), paper);
}

// Edges lie on whole squares and around the sheet.
bool board_is_even(vec2 ray) {
  vec3 h = to_grid * vec3(ray, 1.0);
  if (h.z <= 0.0) return true;
  vec2 b = on_sheet(ray, h.xy / h.z);
  vec2 reach = (6.0 + 1.0 / lens.w) * blur_in_squares(h, b);
  vec2 grid = abs(b - round(b));
  vec2 rim = min(abs(b + sheet.z), abs(b - sheet.xy - sheet.z));
  return all(greaterThan(min(grid, rim), reach));
}

// Pixels from the outline to the first order, positive inside. |d x c| = R |d| is the outline.
float depth_px(vec3 d, vec3 c) {
  vec3 m = cross(d, c);
  float miss = length(m), length_d = length(d);
  vec3 side = m / max(miss, 1e-9);
  vec2 slope = vec2(dot(side, vec3(0.0, -c.z, c.y)), dot(side, vec3(c.z, 0.0, -c.x))) - radius * d.xy / length_d;
  return (radius * length_d - miss) * lens.x / max(length(slope), 1e-6);
}

float sphere_light(vec2 ray) {
  float seen = light.w;
  vec3 d = vec3(ray, 1.0), way = normalize(d);
  for (int i = 0; i < spheres; ++i) {
    vec3 c = centre[i];
    // Where the ray enters, or passes nearest.
    float along = dot(way, c), miss = length(cross(way, c));
    vec3 normal = normalize(way * (along - sqrt(max(radius * radius - miss * miss, 0.0))) - c);
    float shade = light.z * (0.6 - 0.4 * normal.y);
    seen = mix(seen, shade, beyond(depth_px(d, c) / lens.w));
  }
  return seen;
}

bool spheres_are_even(vec2 ray) {
  float least = 1e6;
  for (int i = 0; i < spheres; ++i) least = min(least, abs(depth_px(vec3(ray, 1.0), centre[i])));
  return least > 6.0 * lens.w + 1.0;
}

void main() {
  vec2 pixel = floor(gl_FragCoord.xy) + origin;
  vec2 ray = undistorted((pixel - lens.yz) / lens.x);
  bool even = spheres > 0 ? spheres_are_even(ray) : board_is_even(ray);
  int points = even ? 1 : 4;  // away from edges one says as much
  float spread = even ? 0.0 : gauss / lens.x;
  float sum = 0.0;
  for (int k = 0; k < points; ++k) {
    // Within a pixel the lens is straight to a few parts in a thousand of a pixel, alike to all sides.
    vec2 at = ray + spread * vec2((k & 1) * 2 - 1, (k & 2) - 1);
    sum += spheres > 0 ? sphere_light(at) : board_light(at);
  }
  float off_axis = 1.0 + dot(ray, ray);
  level = light.y + light.x * sum / (float(points) * off_axis * off_axis);
}
