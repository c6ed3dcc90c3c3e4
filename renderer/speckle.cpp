#include "renderer/speckle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "core/random.h"

namespace understudy::renderer {
namespace {

constexpr double kSecondZero = 7.0156;  // of J1: 91 % of the energy lies inside
// Ending there rounds the aperture's edge and widens the correlation area by this (transform of the cut
// kernel, fourth moment over squared second); the kernel is drawn as much narrower.
constexpr double kWidening = 1.0902;
constexpr float kDark = 0.05f;   // [grey levels]: speckle of less light is not computed
constexpr int kFinestField = 4;  // field points per sample, along each axis
constexpr int kTable = 2048;

double kernel_reach(const SpeckleOptics& o) {  // [m] on the surface
  return kSecondZero / (2 * std::numbers::pi) * o.wavelength / (o.aperture_sine * std::sqrt(kWidening));
}

/// The field repeats itself within wavelength / (2 sin u); half of that resolves its intensity too.
double resolved(const SpeckleOptics& o) { return o.wavelength / (4 * o.aperture_sine); }

int field_points_per_sample(const SpeckleOptics& o) {
  const double sample = o.distance / (o.focal_px * kSamplesPerPixel);
  return std::clamp(static_cast<int>(std::ceil(sample / resolved(o))), 1, kFinestField);
}

/// 2 J1(v) / v against the square of v, which ends at its second zero.
const std::array<double, kTable>& airy_amplitudes() {
  static const std::array<double, kTable> values = [] {
    std::array<double, kTable> made{};
    for (int k = 0; k < kTable; ++k) {
      const double v = kSecondZero * std::sqrt((k + 0.5) / kTable);
      made[static_cast<std::size_t>(k)] = 2 * std::cyl_bessel_j(1.0, v) / v;
    }
    return made;
  }();
  return values;
}

/// Against the square of the distance; energy 1 over the surface.
class AmplitudeSpread {
 public:
  explicit AmplitudeSpread(const SpeckleOptics& o)
      : scale_(kTable / (kernel_reach(o) * kernel_reach(o))), values_(airy_amplitudes()) {
    double energy = 0;
    for (const double value : values_) energy += value * value;
    energy *= std::numbers::pi / scale_;  // rings of equal area
    for (double& value : values_) value /= std::sqrt(energy);
  }
  double operator()(double distance_squared) const {
    const double k = distance_squared * scale_;
    return k < kTable ? values_[static_cast<std::size_t>(static_cast<int>(k))] : 0;
  }

 private:
  double scale_;
  std::array<double, kTable> values_;
};

struct Scatterer {
  std::complex<double> amplitude;
  double x = 0, y = 0;  // field points, summed over what falls into its cell
  double depth = 0;     // [m], summed
  int points = 0;
};

std::complex<double> circular_gaussian(std::uint64_t key) {
  const double u = (static_cast<double>(hash_bits(key, 1) >> 11) + 1) * 0x1.0p-53;
  const double phase = 2 * std::numbers::pi * static_cast<double>(hash_bits(key, 2) >> 11) * 0x1.0p-53;
  return std::polar(std::sqrt(-std::log(u)), phase);
}

std::uint64_t cell_key(const SpeckleOptics& o, Owner owner, const Vec3& p, double cell) {
  std::uint64_t key = hash_bits(o.seed, static_cast<std::uint64_t>(owner));
  for (int axis = 0; axis < 3; ++axis) {
    key = hash_bits(key, static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p[axis] / cell))));
  }
  return key;
}

bool is_lit(const Sample& sample) { return sample.laser > kDark; }

std::optional<Region> lit_samples(const SampleGrid& grid) {
  int left = grid.x + grid.width, right = grid.x - 1, top = grid.y + grid.height, bottom = grid.y - 1;
  for (int j = grid.y; j < grid.y + grid.height; ++j) {
    for (int i = grid.x; i < grid.x + grid.width; ++i) {
      if (!is_lit(grid.at(i, j))) continue;
      left = std::min(left, i), right = std::max(right, i);
      top = std::min(top, j), bottom = std::max(bottom, j);
    }
  }
  if (right < left) return std::nullopt;
  return Region{left, top, right - left + 1, bottom - top + 1};
}

Region grown(const Region& r, int by, const SampleGrid& within) {
  const int left = std::max(r.x - by, within.x), top = std::max(r.y - by, within.y);
  const int right = std::min(r.x + r.width + by, within.x + within.width);
  const int bottom = std::min(r.y + r.height + by, within.y + within.height);
  return {left, top, right - left, bottom - top};
}

/// Depth between the samples; the nearest sample's where surfaces meet.
double depth_at(const SampleGrid& grid, double i, double j) {
  const int i0 =
      std::clamp(static_cast<int>(std::floor(i)), grid.x, std::max(grid.x, grid.x + grid.width - 2));
  const int j0 =
      std::clamp(static_cast<int>(std::floor(j)), grid.y, std::max(grid.y, grid.y + grid.height - 2));
  const Sample &s00 = grid.at(i0, j0), &s10 = grid.at(i0 + 1, j0);
  const Sample &s01 = grid.at(i0, j0 + 1), &s11 = grid.at(i0 + 1, j0 + 1);
  if (s00.owner != s10.owner || s00.owner != s01.owner || s00.owner != s11.owner) {
    return grid.at(static_cast<int>(std::lround(i)), static_cast<int>(std::lround(j))).depth;
  }
  const double a = i - i0, b = j - j0;
  return (1 - b) * ((1 - a) * s00.depth + a * s10.depth) + b * ((1 - a) * s01.depth + a * s11.depth);
}

/// Field points of a region of samples.
struct Field {
  Region points;
  std::vector<std::complex<double>> values;
  std::vector<std::array<int, 2>> wanted;  // of each row: the first and the last
};

Field field_of(const SampleGrid& grid, const Region& lit, int fine) {
  Field field{{lit.x * fine, lit.y * fine, lit.width * fine, lit.height * fine}, {}, {}};
  field.values.resize(static_cast<std::size_t>(field.points.width) *
                      static_cast<std::size_t>(field.points.height));
  for (int j = lit.y; j < lit.y + lit.height; ++j) {
    int first = lit.x + lit.width, last = lit.x - 1;
    for (int i = lit.x; i < lit.x + lit.width; ++i)
      if (is_lit(grid.at(i, j))) first = std::min(first, i), last = i;
    field.wanted.insert(field.wanted.end(), static_cast<std::size_t>(fine),
                        {first * fine, (last + 1) * fine - 1});
  }
  return field;
}

/// First and last field points of a row with a wanted one within `reach` rows and columns.
std::array<int, 2> near_wanted(const Field& field, int row, int reach) {
  const Region& r = field.points;
  int first = r.x + r.width + reach, last = r.x - 1 - reach;
  for (int b = std::max(row - reach, r.y); b <= std::min(row + reach, r.y + r.height - 1); ++b) {
    const auto [from, to] = field.wanted[static_cast<std::size_t>(b - r.y)];
    if (from > to) continue;
    first = std::min(first, from - reach);
    last = std::max(last, to + reach);
  }
  return {first, last};
}

/// [m], of the cells that scatter: no finer than the field's points.
double cell_size(const SpeckleOptics& o, int fine) {
  return std::max(resolved(o), o.distance / (o.focal_px * kSamplesPerPixel * fine));
}

/// [points], from where a cell has its first point to where its light ends, on the surface that is nearest.
int reach_of_cell(const SampleGrid& grid, const SpeckleOptics& o, const Region& area, int fine) {
  float nearest = HUGE_VALF;
  for (int j = area.y; j < area.y + area.height; ++j)
    for (int i = area.x; i < area.x + area.width; ++i)
      if (owner_of(grid.at(i, j)) != Owner::nothing) nearest = std::min(nearest, grid.at(i, j).depth);
  const double pitch = static_cast<double>(nearest) / (o.focal_px * kSamplesPerPixel * fine);
  const double diagonal = std::sqrt(3.0) * cell_size(o, fine);
  return static_cast<int>(std::ceil((kernel_reach(o) + diagonal) / pitch)) + 2;
}

/// Those of `area` whose light reaches a wanted point of the field, and some more, in the order in which rows
/// meet them, so that the sums below have one order too.
std::vector<Scatterer> scatterers(const SampleGrid& grid, const Lens& lens, const SpeckleOptics& o,
                                  const Region& area, const Field& field, int fine) {
  const double cell = cell_size(o, fine);
  const int reach = reach_of_cell(grid, o, area, fine);
  std::vector<Scatterer> found;
  std::unordered_map<std::uint64_t, std::size_t> place;
  place.reserve(static_cast<std::size_t>(area.width * fine) * static_cast<std::size_t>(area.height * fine));
  for (int b = area.y * fine; b < (area.y + area.height) * fine; ++b) {
    const auto [first, last] = near_wanted(field, b, reach);
    for (int a = std::max(area.x * fine, first); a <= std::min((area.x + area.width) * fine - 1, last); ++a) {
      const double i = (a + 0.5) / fine - 0.5, j = (b + 0.5) / fine - 0.5;
      const Owner owner =
          owner_of(grid.at(static_cast<int>(std::floor(i + 0.5)), static_cast<int>(std::floor(j + 0.5))));
      if (owner == Owner::nothing) continue;
      const double depth = fine == 1 ? static_cast<double>(grid.at(a, b).depth) : depth_at(grid, i, j);
      const Vec2 ray = lens.ray(i, j);
      const Vec3 p_C = depth * Vec3(ray.x(), ray.y(), 1);
      const std::uint64_t key = cell_key(o, owner, owner == Owner::tool ? o.X_TC * p_C : o.X_WC * p_C, cell);
      const auto [entry, is_new] = place.try_emplace(key, found.size());
      if (is_new) found.push_back({circular_gaussian(key)});
      Scatterer& s = found[entry->second];
      s.x += a;
      s.y += b;
      s.depth += depth;
      ++s.points;
    }
  }
  return found;
}

void add(Field& field, const Scatterer& s, const AmplitudeSpread& spread, const SpeckleOptics& o, int fine,
         int reach_limit) {
  const double x = s.x / s.points, y = s.y / s.points;
  const double pitch = s.depth / s.points / (o.focal_px * kSamplesPerPixel * fine);  // [m] between points
  const double radius = kernel_reach(o) / pitch;                                     // [points]
  const int reach = std::min(static_cast<int>(std::ceil(radius)), reach_limit);
  const int cx = static_cast<int>(std::lround(x)), cy = static_cast<int>(std::lround(y));
  const Region& r = field.points;
  // A cell with more surface scatters more: the energy is that of its field points.
  const std::complex<double> amplitude = s.amplitude * (std::sqrt(static_cast<double>(s.points)) * pitch);
  for (int b = std::max(cy - reach, r.y); b <= std::min(cy + reach, r.y + r.height - 1); ++b) {
    const double half_row = std::sqrt(std::max(0.0, radius * radius - (b - y) * (b - y)));  // of a round spot
    const int half =
        std::min(static_cast<int>(std::lround(half_row)), reach);  // cx is no farther than that from x
    const auto [first, last] = field.wanted[static_cast<std::size_t>(b - r.y)];
    const int left = std::max(cx - half, first), right = std::min(cx + half, last);
    std::complex<double>* row =
        &field.values[static_cast<std::size_t>(b - r.y) * static_cast<std::size_t>(r.width)];
    for (int a = left; a <= right; ++a) {
      const double distance_squared = ((a - x) * (a - x) + (b - y) * (b - y)) * pitch * pitch;
      row[a - r.x] += amplitude * spread(distance_squared);
    }
  }
}

}  // namespace

int speckle_margin(const SpeckleOptics& o) {
  // One and a half times, for surfaces nearer to the camera than the typical distance.
  const double pixel = o.distance / o.focal_px;
  return static_cast<int>(std::ceil((1.5 * kernel_reach(o) + 2 * resolved(o)) / pixel)) + 2;
}

void apply_speckle(SampleGrid& grid, const Lens& lens, const SpeckleOptics& optics) {
  const auto lit = lit_samples(grid);
  if (!lit || grid.width < 2 || grid.height < 2) return;
  const int fine = field_points_per_sample(optics);
  const int margin = speckle_margin(optics);
  const Region area = grown(*lit, kSamplesPerPixel * margin, grid);
  Field field = field_of(grid, *lit, fine);
  const AmplitudeSpread spread(optics);
  const int reach_limit = kSamplesPerPixel * fine * (margin - 2);
  for (const Scatterer& s : scatterers(grid, lens, optics, area, field, fine)) {
    add(field, s, spread, optics, fine, reach_limit);
  }
  const double share = 1.0 / (fine * fine);
  for (int j = lit->y; j < lit->y + lit->height; ++j) {
    for (int i = lit->x; i < lit->x + lit->width; ++i) {
      Sample& sample = grid.at(i, j);
      if (!is_lit(sample)) continue;
      double intensity = 0;
      for (int b = 0; b < fine; ++b) {
        for (int a = 0; a < fine; ++a) {
          const int row = (j - lit->y) * fine + b, column = (i - lit->x) * fine + a;
          intensity += std::norm(
              field.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(field.points.width) +
                           static_cast<std::size_t>(column)]);
        }
      }
      sample.laser = static_cast<float>(sample.laser * intensity * share);
    }
  }
}

}  // namespace understudy::renderer
