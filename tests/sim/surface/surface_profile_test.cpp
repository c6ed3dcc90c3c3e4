#include "sim/surface/surface_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "sim/surface/roughness.h"

namespace understudy::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kPi = std::numbers::pi;
constexpr double kLayer = 0.2e-3, kRadius = kLayer / 2;
constexpr double kFloat = 4e-9;  // [m], coordinates of beads up to 30 mm from the origin

std::array<float, 3> narrow(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// Along y, this long to both sides of its middle.
Bead along_y(const Vec3& middle, const Vec3& up, double width, double height = kLayer) {
  Bead bead;
  bead.from_W = narrow(middle - Vec3(0, 2e-3, 0));
  bead.to_W = narrow(middle + Vec3(0, 2e-3, 0));
  bead.up_W = narrow(up);
  bead.width = static_cast<float>(width);
  bead.height = static_cast<float>(height);
  return bead;
}

// A face that rises at `slope` towards -x: its normal, and the way up it.
struct Slope {
  explicit Slope(double slope_deg)
      : angle(from_deg(slope_deg)),
        normal(std::sin(angle), 0, std::cos(angle)),
        up(-std::cos(angle), 0, std::sin(angle)) {}
  double angle;
  Vec3 normal, up;
};

constexpr int kRows = 140;
constexpr double kWide = 3e-3;

// Planar layers whose outer sides follow the slope; p(k) = k * period * up is the centre of side k's arc.
double staircase_period(const Slope& slope) { return kLayer / std::sin(slope.angle); }
Workpiece staircase(const Slope& slope) {
  Workpiece part(nullptr);
  for (int k = 0; k < kRows; ++k) {
    const Vec3 arc = k * staircase_period(slope) * slope.up + Vec3(0, 0, kLayer);
    part.add(along_y(arc - Vec3((kWide - kLayer) / 2, 0, 0), Vec3::UnitZ(), kWide));
  }
  return part;
}

// One conformal layer: rows side by side on the slope.
Workpiece conformal(const Slope& slope, double width, double pitch) {
  Workpiece part(nullptr);
  for (int k = 0; k < kRows; ++k)
    part.add(along_y(k * pitch * slope.up + Vec3(0, 0, kLayer), slope.normal, width));
  return part;
}

// Twenty rows a sampling length, 100 points a row.
Roughness measure(const Workpiece& part, const Slope& slope, double period, double tip_radius = 0) {
  ProfileLine line;
  line.from_W = 5 * period * slope.up + Vec3(0, 0, kLayer);
  line.to_W = (kRows - 6) * period * slope.up + Vec3(0, 0, kLayer);
  line.probe_W = -slope.normal;
  line.pitch = period / 100;
  line.tip_radius = tip_radius;
  const SurfaceProfile profile = measure_profile(part, nullptr, line);
  EXPECT_EQ(profile.on_beads, profile.heights.size());
  RoughnessSettings settings;
  settings.cutoff = 20 * profile.pitch * 100;
  return roughness(profile.heights, profile.pitch, settings);
}

// Of circles at distance `period` along a wall, cut where neighbours meet: mean magnitude about the mean
// line.
double scallop(double half_flat, double half_period) {
  const double to_cusp = half_period - half_flat;
  return kRadius - std::sqrt(kRadius * kRadius - to_cusp * to_cusp);
}

TEST(SurfaceProfile, AWallOfRoundSidesHasTheRoughnessOfHalfCircles) {
  const Slope wall(90);
  const double tip = 0.2e-6;
  const Roughness r = measure(staircase(wall), wall, kLayer, tip);
  // Height sqrt(r^2 - s^2), mean pi r / 4, crossed at s0.
  const double mean = kPi * kRadius / 4, s0 = std::sqrt(kRadius * kRadius - mean * mean);
  const double above = 0.5 * (s0 * mean + kRadius * kRadius * std::asin(s0 / kRadius)) - mean * s0;
  // 100 points a row, the cusp's flanks upright at its bottom.
  EXPECT_NEAR(r.ra, 2 * above / kRadius, 0.01 * kRadius);
  // The tip's side points hold it up, half its radius away from where two layers touch.
  const double held =
      std::sqrt(std::pow(kRadius, 2) - std::pow(kRadius - tip / 2, 2)) - tip * (1 - std::sqrt(0.75));
  EXPECT_NEAR(r.rz, kRadius - held, 1e-3 * kRadius);
  EXPECT_NEAR(*r.rsm, kLayer, 1e-3 * kLayer);
}

// Height of the layers' outline over the line of arc centres, at s up the slope from one of them: arcs, and
// the treads that run inwards from the top of each.
double outline(const Slope& slope, double s) {
  double highest = -1;
  for (int k = -3; k <= 3; ++k) {
    const double from = s - k * staircase_period(slope);
    if (std::abs(from) <= kRadius) highest = std::max(highest, std::sqrt(kRadius * kRadius - from * from));
    const double inwards = (from - kRadius * std::sin(slope.angle)) / std::cos(slope.angle);
    if (inwards >= 0 && inwards <= kWide - kLayer)
      highest = std::max(highest, kRadius * std::cos(slope.angle) - inwards * std::sin(slope.angle));
  }
  return highest;
}

TEST(SurfaceProfile, AStaircaseHasTheRoughnessOfItsOutline) {
  for (const double slope_deg : {30.0, 45.0, 60.0}) {
    const Slope slope(slope_deg);
    const double period = staircase_period(slope);
    constexpr int kSteps = 20000;
    double mean = 0, ra = 0;
    for (int i = 0; i < kSteps; ++i) mean += outline(slope, period * i / kSteps) / kSteps;
    for (int i = 0; i < kSteps; ++i) ra += std::abs(outline(slope, period * i / kSteps) - mean) / kSteps;
    // The valley is where the tangent of the next arc meets the tread below.
    const double inwards = (period - kRadius - kRadius * std::sin(slope.angle)) / std::cos(slope.angle);
    const double valley = kRadius * std::cos(slope.angle) - inwards * std::sin(slope.angle);
    const Roughness r = measure(staircase(slope), slope, period);
    // The riser is upright: one of 100 points falls to either side of it.
    EXPECT_NEAR(r.ra, ra, 0.01 * ra) << slope_deg;
    // The valley is a point of the tread's slope: the nearest of 100 points is at most one away.
    EXPECT_LE(r.rz, kRadius - valley + 2e-3 * kRadius) << slope_deg;
    EXPECT_GE(r.rz, kRadius - valley - period / 100 * std::tan(slope.angle)) << slope_deg;
    EXPECT_NEAR(*r.rsm, period, 2e-3 * period) << slope_deg;
  }
}

TEST(SurfaceProfile, ConformalRowsLeaveTheStadiumsScallops) {
  for (const double slope_deg : {0.0, 35.0, 70.0}) {
    const Slope slope(slope_deg);
    for (const double pitch : {0.40e-3, 0.45e-3, 0.49e-3}) {
      const double width = 0.5e-3;
      const Roughness r = measure(conformal(slope, width, pitch), slope, pitch);
      const double expected = scallop((width - kLayer) / 2, pitch / 2);
      // Cusps fall on points.
      EXPECT_NEAR(r.rz, expected, 2e-3 * expected + kFloat) << slope_deg << " deg, " << pitch;
    }
  }
}

TEST(SurfaceProfile, TheStaircaseIsWorseThanConformalRowsByTheGeometrysRatio) {
  const Slope slope(30);
  const double width = 0.5e-3, pitch = 0.45e-3;
  const Roughness planar = measure(staircase(slope), slope, staircase_period(slope));
  const Roughness smooth = measure(conformal(slope, width, pitch), slope, pitch);
  const double inwards =
      (staircase_period(slope) - kRadius * (1 + std::sin(slope.angle))) / std::cos(slope.angle);
  const double step = kRadius * (1 - std::cos(slope.angle)) + inwards * std::sin(slope.angle);
  const double ratio = step / scallop((width - kLayer) / 2, pitch / 2);
  EXPECT_GT(ratio, 4);
  EXPECT_NEAR(planar.rz / smooth.rz, ratio, 0.03 * ratio);
}

TEST(SurfaceProfile, ATiltedLineMeasuresTheSameSurface) {
  const Slope flat(0);
  const double pitch = 0.45e-3;
  const Workpiece part = conformal(flat, 0.5e-3, pitch);
  const Roughness straight = measure(part, flat, pitch);
  ProfileLine line;
  const double tilt = from_deg(5), length = 100 * pitch;
  line.from_W = Vec3(-5 * pitch, 0, 2 * kLayer);
  line.to_W = line.from_W + length * Vec3(-1, 0, std::tan(tilt));
  line.probe_W = Vec3(-std::sin(tilt), 0, -std::cos(tilt));  // square to the line
  line.tip_radius = 0;
  line.pitch = pitch / 100;
  line.reach = 10e-3;
  const SurfaceProfile profile = measure_profile(part, nullptr, line);
  EXPECT_NEAR(profile.tilt, tilt, 1e-4);
  RoughnessSettings settings;
  settings.cutoff = 20 * pitch;
  const Roughness tilted = roughness(profile.heights, profile.pitch, settings);
  EXPECT_NEAR(tilted.rz, straight.rz, 0.01 * straight.rz);
  EXPECT_NEAR(*tilted.rsm, pitch, 1e-3 * pitch);
}

// A tube about y, many-sided enough to be round to 0.05 um.
std::shared_ptr<const geometry::Mesh> tube(double radius, const Vec3& centre) {
  constexpr int kSides = 1000;
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < kSides; ++i)
    for (const double y : {-5e-3, 5e-3})
      vertices.push_back(
          centre + Vec3(radius * std::sin(2 * kPi * i / kSides), y, radius * std::cos(2 * kPi * i / kSides)));
  for (int i = 0; i < kSides; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % kSides);
    triangles.push_back({a, b, a + 1});
    triangles.push_back({b, b + 1, a + 1});
  }
  return std::make_shared<const geometry::Mesh>(vertices, triangles);
}

TEST(SurfaceProfile, HeightsAreAgainstTheIntendedCurve) {
  const double radius = 10e-3, centres = radius - kRadius, step = from_deg(1);
  const Vec3 centre(0, 0, 12e-3);
  Workpiece part(nullptr);
  for (int k = -30; k <= 30; ++k) {
    const Vec3 out(std::sin(k * step), 0, std::cos(k * step));
    part.add(along_y(centre + centres * out, out, kLayer));
  }
  const auto intended = tube(radius, centre);
  ASSERT_GT(intended->nearest(centre + Vec3(0, 0, 2 * radius)).normal.z(), 0.99);
  ProfileLine line;
  line.from_W = centre + Vec3(-2e-3, 0, radius);
  line.to_W = centre + Vec3(2e-3, 0, radius);
  line.probe_W = probe_into(*intended, line.from_W, line.to_W);
  EXPECT_NEAR(line.probe_W.z(), -1, 1e-4);  // facets of 0.36 deg
  line.pitch = 1e-6;
  line.tip_radius = 0;
  const SurfaceProfile profile = measure_profile(part, intended.get(), line);
  const auto [low, high] = std::minmax_element(profile.heights.begin(), profile.heights.end());
  const double cusp = centres * std::cos(step / 2) +
                      std::sqrt(std::pow(kRadius, 2) - std::pow(centres * std::sin(step / 2), 2));
  EXPECT_NEAR(*high, 0, 0.1e-6);  // the tube's facets, twice
  EXPECT_NEAR(*low, cusp - radius,
              0.5e-6);  // 5 um of pitch on a flank of 60 deg, less the tilt's second order
  EXPECT_NEAR(profile.tilt, std::asin(0.2), from_deg(0.4));  // 2 of 10 mm, one facet
}

TEST(SurfaceProfile, TheTipRidesOverASlit) {
  Workpiece part(nullptr);
  // Two square-sided blocks, as good as: wide beads, 0.5 um apart end to end at the line.
  const double gap = 0.5e-6;
  for (const double side : {-1.0, 1.0})
    part.add(along_y(Vec3(side * (1.5e-3 + gap / 2), 0, 0.5e-3), Vec3::UnitZ(), 3e-3, 4e-6));
  ProfileLine line;
  line.from_W = Vec3(-0.1e-3, 0, 0.502e-3);
  line.to_W = Vec3(0.1e-3, 0, 0.502e-3);
  line.reach = 0.4e-3;
  // A single ray in the slit's middle meets nothing.
  line.tip_radius = 0;
  EXPECT_THROW(measure_profile(part, nullptr, line), InputError);
  line.tip_radius = 2e-6;
  const SurfaceProfile profile = measure_profile(part, nullptr, line);
  // 1 um off the middle the edge, 2 um round, is 0.25 + 2 - 1 = 1.25 um from its flat: 0.439 um down; the tip
  // adds 0.268 um.
  const auto [low, high] = std::minmax_element(profile.heights.begin(), profile.heights.end());
  EXPECT_NEAR(*high - *low, 2e-6 - std::sqrt(4 - 1.25 * 1.25) * 1e-6 + 0.268e-6, 2e-9);
}

TEST(SurfaceProfile, CountsWhatItMet) {
  Workpiece part(nullptr);
  for (int k = 0; k < 3; ++k) part.add(along_y(Vec3(k * 1e-3, 0, kRadius), Vec3::UnitZ(), 0.5e-3));
  ProfileLine line;
  line.from_W = Vec3(0, 0, kLayer);
  line.to_W = Vec3(2e-3, 0, kLayer);
  const SurfaceProfile profile = measure_profile(part, nullptr, line);
  EXPECT_EQ(profile.on_beads + profile.on_table, profile.heights.size());
  // Half the line is bare: 0.5 mm of each millimetre.
  EXPECT_NEAR(static_cast<double>(profile.on_table), 200, 2);
}

TEST(SurfaceProfile, RefusesALineThatMissesThePart) {
  Workpiece part(nullptr);
  part.add(along_y(Vec3(0, 0, 5e-3), Vec3::UnitZ(), 3e-3));
  ProfileLine line;
  line.from_W = Vec3(-1e-3, 0, 5e-3);
  line.to_W = Vec3(3e-3, 0, 5e-3);
  const auto run = [&] { measure_profile(part, nullptr, line); };
  EXPECT_THAT(run, ThrowsMessage<InputError>(HasSubstr("nothing at 2.505 mm of it within 2 mm")));
  line.from_W = Vec3(10e-3, 0, 1e-3);
  line.to_W = Vec3(13e-3, 0, 1e-3);
  EXPECT_THAT(run, ThrowsMessage<InputError>(
                       HasSubstr("of its 601 points none is on a bead (0 on the insert, 601 on")));
}

TEST(SurfaceProfile, RefusesWhatMakesNoSense) {
  Workpiece part(nullptr);
  part.add(along_y(Vec3(0, 0, kRadius), Vec3::UnitZ(), 3e-3));
  ProfileLine good;
  good.from_W = Vec3(-1e-3, 0, kLayer);
  good.to_W = Vec3(1e-3, 0, kLayer);
  measure_profile(part, nullptr, good);
  const auto with = [&](auto change) {
    return [&, change] {
      ProfileLine line = good;
      change(line);
      measure_profile(part, nullptr, line);
    };
  };
  EXPECT_THAT(with([](ProfileLine& l) { l.to_W = l.from_W; }),
              ThrowsMessage<InputError>(HasSubstr("is 0 mm long")));
  EXPECT_THAT(with([](ProfileLine& l) { l.pitch = 1e-9; }),
              ThrowsMessage<InputError>(HasSubstr("more than 1000000")));
  EXPECT_THAT(with([](ProfileLine& l) { l.pitch = 1e-3; }),
              ThrowsMessage<InputError>(HasSubstr("has 3 points, fewer than 16")));
  EXPECT_THAT(with([](ProfileLine& l) { l.pitch = 0; }),
              ThrowsMessage<InputError>(HasSubstr("pitch is 0 um")));
  EXPECT_THAT(with([](ProfileLine& l) { l.reach = -1; }),
              ThrowsMessage<InputError>(HasSubstr("reach is -1000 mm")));
  EXPECT_THAT(with([](ProfileLine& l) { l.tip_radius = -1e-6; }),
              ThrowsMessage<InputError>(HasSubstr("tip radius is -1 um")));
  EXPECT_THAT(with([](ProfileLine& l) { l.probe_W = Vec3::Zero(); }),
              ThrowsMessage<InputError>(HasSubstr("direction has length 0")));
  EXPECT_THAT(with([](ProfileLine& l) { l.probe_W = Vec3(1, 0, -1); }),
              ThrowsMessage<InputError>(HasSubstr("is 45 deg off square")));
  EXPECT_THAT(with([](ProfileLine& l) { l.to_W.x() = std::nan(""); }),
              ThrowsMessage<InputError>(HasSubstr("nan mm long")));
}

}  // namespace
}  // namespace understudy::sim
