#include "control/gap/gap_reading.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/gap/gap_sensor.h"
#include "core/error.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "geometry/mesh.h"
#include "tests/control/gap/dot_world.h"
#include "tests/shipped_hexapod.h"

namespace understudy::control {
namespace {

using testing::HasSubstr;

constexpr double kBottleRadius = 15.5e-3;  // [m], Song 2015, 6.2

vision::DotMeasurement dot_at(const Vec2& pixel, double sigma_px = 0.1) {
  vision::DotMeasurement dot;
  dot.status = vision::DotStatus::ok;
  dot.position_px = pixel;
  dot.covariance_px2 = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  return dot;
}

/// The tool upright over the origin of W at a gap above a surface that passes below the tip at z = 0.
Pose upright(double gap) { return make_pose(Quat::Identity(), Vec3(0, 0, gap)); }

DotWorld flat() { return plane_through(Vec3::Zero(), Vec3::UnitZ()); }
DotWorld tilted(double degrees_about_x) {
  return plane_through(Vec3::Zero(),
                       Vec3(0, -std::sin(from_deg(degrees_about_x)), std::cos(from_deg(degrees_about_x))));
}
DotWorld bottle(const Vec3& axis) { return cylinder_around(Vec3(0, 0, -kBottleRadius), axis, kBottleRadius); }

LocalSurface slope_in_y(double degrees) {
  LocalSurface s;
  s.slope.y() = std::tan(from_deg(degrees));
  return s;
}
/// The osculating quadric of a cylinder of this radius around x (curved along y).
LocalSurface curved_in_y(double radius) {
  LocalSurface s;
  s.curvature(1, 1) = -1 / radius;
  return s;
}

/// Micrometres of gap for a pixel, from two exact dots 2 um apart.
double um_per_px(const DotWorld& world, double gap) {
  const Vec2 a = *exact_dot(hexapod(), world, upright(gap - 1e-6));
  const Vec2 b = *exact_dot(hexapod(), world, upright(gap + 1e-6));
  return 2 / (b - a).norm();
}

/// A plane through the beam's crossing with the tip plane, leaned about x: its dot at gap 0 is in focus.
DotWorld through_focus(double degrees_about_x) {
  DotWorld world = tilted(degrees_about_x);
  world.point.y() = 1.1e-3;
  return world;
}

TEST(GapOptics, ScaleIsThatOfTheReference) {
  // docs/reference.md#dot-and-gap: 14.2 um/px on a flat, 21.2 at 30 degrees tilt (to their last digit, and
  // perspective over the range of gaps from which they were taken).
  EXPECT_NEAR(um_per_px(through_focus(0), 0), 14.2, 0.1);
  EXPECT_NEAR(um_per_px(through_focus(-30), 0), 21.2, 0.1);
  // 14.8 on the 31 mm bottle, in a prototype whose dot lay nearer to the axis: ours meets a slope 1 degree
  // steeper.
  EXPECT_NEAR(um_per_px(bottle(Vec3::UnitX()), 0.13e-3), 14.8, 0.3);
  // Our bottle lies along the laser's plane and is flat there.
  EXPECT_NEAR(um_per_px(bottle(Vec3::UnitY()), 0), 14.2, 0.1);
}

TEST(GapOptics, ShiftFollowsTheAngles) {
  // A beam at alpha meets a surface leaned by tau after gap / (cos(alpha) - tan(tau) sin(alpha)); of that way
  // sin(alpha) goes across the image and cos(alpha) sin(beta) down it.
  const double alpha = from_deg(40), beta = from_deg(45);
  for (double degrees : {-30.0, -15.0, 0.0, 15.0, 30.0}) {
    const double way = 1 / (std::cos(alpha) - std::tan(from_deg(degrees)) * std::sin(alpha));
    const double px_per_mm = 64 * way * std::hypot(std::sin(alpha), std::cos(alpha) * std::sin(beta));
    EXPECT_NEAR(um_per_px(through_focus(degrees), 0), 1e3 / px_per_mm, 1e-4) << degrees;  // finite difference
  }
}

TEST(GapReading, PredictsTheExactDotOnPlanes) {
  for (double tilt : {-30.0, -10.0, 0.0, 20.0, 30.0})
    for (double gap : {-0.5e-3, 0.0, 0.13e-3, 1e-3, 3e-3}) {
      const auto exact = exact_dot(hexapod(), tilted(tilt), upright(gap));
      Vec2 pixel;
      if (!predict_dot(hexapod(), slope_in_y(tilt), gap, pixel)) continue;
      EXPECT_LT((pixel - *exact).norm(), 1e-8) << tilt << " degrees, gap " << gap;  // rounding
    }
}

TEST(GapReading, PredictsTheDotOnTheBottleToItsQuartic) {
  for (double gap : {0.05e-3, 0.13e-3, 0.5e-3, 2e-3}) {
    const auto exact = exact_dot(hexapod(), bottle(Vec3::UnitX()), upright(gap));
    Vec2 pixel;
    ASSERT_TRUE(predict_dot(hexapod(), curved_in_y(kBottleRadius), gap, pixel));
    // The quadric leaves e^4 / 8 R^3 of the circle: 0.03 um at 1 mm, 0.002 px.
    EXPECT_LT((pixel - *exact).norm(), 0.003) << gap;
  }
}

TEST(GapReading, InvertsExactDotsOverTheWholeRange) {
  Random random(7, "gap reading");
  const Camera& camera = hexapod().microscope.camera;
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    const double gap = random.uniform(-0.9e-3, 7.9e-3);
    LocalSurface surface;
    surface.slope = 0.5 * uniform_vec2(random, 1);
    surface.curvature(0, 0) = random.uniform(-100, 100);
    surface.curvature(1, 1) = random.uniform(-100, 100);
    surface.curvature(0, 1) = surface.curvature(1, 0) = random.uniform(-50, 50);
    Vec2 pixel;
    if (!predict_dot(hexapod(), surface, gap, pixel)) continue;
    GapReading reading;
    ASSERT_TRUE(read_gap(hexapod(), surface, dot_at(pixel), reading)) << "gap " << gap << ", draw " << i;
    ASSERT_NEAR(reading.gap, gap, 1e-9) << "draw " << i;
    ASSERT_LT(reading.residual_px, 1e-3);
    ++read;
    EXPECT_TRUE(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width && pixel.y() <= camera.height);
  }
  EXPECT_GT(read, 10000);
}

TEST(GapReading, ADotBesideTheAxisAddsSlopeAndCurvature) {
  // docs/reference.md#dot-and-gap: a dot e beside the axis adds e tan(tilt) + e^2 / 2R to what a flat, square
  // surface would say. Here the surface falls away from the axis towards the dot, so the flat model sees a
  // larger gap.
  const double gap = 0.13e-3;
  const auto flat_reading = [](const DotWorld& world, double g) {
    GapReading reading;
    EXPECT_TRUE(read_gap(hexapod(), {}, dot_at(*exact_dot(hexapod(), world, upright(g))), reading));
    return reading.gap;
  };
  const double tan40 = std::tan(from_deg(40));
  {
    const double seen = flat_reading(bottle(Vec3::UnitX()), gap);
    const double e = 1.1e-3 - seen * tan40;
    EXPECT_NEAR(seen - gap, e * e / (2 * kBottleRadius), 0.1e-6);  // the quartic
    EXPECT_GT(seen - gap, 25e-6);
  }
  {
    const double seen = flat_reading(tilted(-20), gap);
    const double e = 1.1e-3 - seen * tan40;
    EXPECT_NEAR(seen - gap, e * std::tan(from_deg(20)), 1e-9);
  }
  // And the model with the true slope and curvature does not err.
  GapReading reading;
  ASSERT_TRUE(read_gap(hexapod(), curved_in_y(kBottleRadius),
                       dot_at(*exact_dot(hexapod(), bottle(Vec3::UnitX()), upright(gap))), reading));
  EXPECT_NEAR(reading.gap, gap, 0.1e-6);
  ASSERT_TRUE(read_gap(hexapod(), slope_in_y(-20), dot_at(*exact_dot(hexapod(), tilted(-20), upright(gap))),
                       reading));
  EXPECT_NEAR(reading.gap, gap, 1e-9);
}

TEST(GapReading, SigmaIsTheDotsSigmaTimesTheScale) {
  GapReading reading;
  const Vec2 pixel = *exact_dot(hexapod(), flat(), upright(0.13e-3));
  ASSERT_TRUE(read_gap(hexapod(), {}, dot_at(pixel, 0.4), reading));
  EXPECT_NEAR(to_um(reading.sigma), 0.4 * um_per_px(flat(), 0.13e-3), 0.01);
}

TEST(GapReading, SigmaIsTheScatterOfNoisyDots) {
  Random random(3, "noisy dots");
  const DotWorld world = tilted(-30);
  const LocalSurface surface = slope_in_y(-30);
  const Vec2 exact = *exact_dot(hexapod(), world, upright(0.2e-3));
  Eigen::Matrix2d factor;  // a covariance that is neither round nor along the track
  factor << 0.5, 0, 0.3, 0.2;
  double squares = 0, sigma = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    vision::DotMeasurement dot = dot_at(exact + factor * normal_vec2(random));
    dot.covariance_px2 = factor * factor.transpose();
    GapReading reading;
    ASSERT_TRUE(read_gap(hexapod(), surface, dot, reading));
    squares += std::pow(reading.gap - 0.2e-3, 2);
    sigma = reading.sigma;
  }
  // Standard error of a standard deviation from 4000 draws: 1.1 %; four of them.
  EXPECT_NEAR(std::sqrt(squares / kDraws) / sigma, 1, 0.045);
}

TEST(GapReading, ResidualIsTheDistanceFromTheTrack) {
  const Vec2 a = *exact_dot(hexapod(), flat(), upright(0.1e-3));
  const Vec2 b = *exact_dot(hexapod(), flat(), upright(1e-3));
  const Vec2 along = (b - a).normalized(), across(-along.y(), along.x());
  GapReading reading;
  ASSERT_TRUE(read_gap(hexapod(), {}, dot_at(a + 7 * across), reading));
  EXPECT_NEAR(reading.residual_px, 7, 1e-3);
  EXPECT_NEAR(reading.gap, 0.1e-3, 1e-7);
}

TEST(GapReading, ADotBeyondEightMillimetresIsNotRead) {
  GapReading reading;
  EXPECT_TRUE(read_gap(hexapod(), {}, dot_at(*exact_dot(hexapod(), flat(), upright(7.9e-3))), reading));
  EXPECT_FALSE(read_gap(hexapod(), {}, dot_at(*exact_dot(hexapod(), flat(), upright(8.1e-3))), reading));
  EXPECT_TRUE(read_gap(hexapod(), {}, dot_at(*exact_dot(hexapod(), flat(), upright(-0.9e-3))), reading));
  EXPECT_FALSE(read_gap(hexapod(), {}, dot_at(*exact_dot(hexapod(), flat(), upright(-1.1e-3))), reading));
  EXPECT_FALSE(read_gap(hexapod(), {}, dot_at(Vec2(std::nan(""), 0)), reading));
}

TEST(GapReading, RegionHoldsTheDotsOfItsGapsWithMargin) {
  const Region region = region_for_gap(hexapod(), {}, 0.5e-3, 0.2e-3, 0.3e-3, 20);
  for (double gap = 0.3e-3; gap <= 0.8e-3; gap += 0.05e-3) {
    const Vec2 dot = *exact_dot(hexapod(), flat(), upright(gap));
    EXPECT_GE(dot.x() - 20, region.x);
    EXPECT_GE(dot.y() - 20, region.y);
    EXPECT_LE(dot.x() + 20, region.x + region.width);
    EXPECT_LE(dot.y() + 20, region.y + region.height);
  }
  // 0.5 mm of gap is 35 px of track; a region much larger than that and its margins wastes the frame.
  EXPECT_LT(region.width, 27 + 2 * 20 + 4);
  EXPECT_LT(region.height, 24 + 2 * 20 + 4);
}

TEST(GapReading, RegionStaysOnTheSensor) {
  const Camera& camera = hexapod().microscope.camera;
  for (double gap : {-1e-3, 0.0, 4e-3, 8e-3, 50e-3}) {
    const Region r = region_for_gap(hexapod(), {}, gap, 1e-3, 1e-3, 60);
    EXPECT_GE(r.x, 0);
    EXPECT_GE(r.y, 0);
    EXPECT_GT(r.width, 0);
    EXPECT_GT(r.height, 0);
    EXPECT_LE(r.x + r.width, camera.width);
    EXPECT_LE(r.y + r.height, camera.height);
  }
}

TEST(GapOptics, DotOfEveryWorkingGapIsWellInsideThePicture) {
  for (const DotWorld& world :
       {flat(), tilted(-20), tilted(20), bottle(Vec3::UnitX()), bottle(Vec3::UnitY())})
    for (double gap = 0; gap <= 4e-3; gap += 0.1e-3) {
      const Vec2 dot = *exact_dot(hexapod(), world, upright(gap));
      EXPECT_GT(dot.minCoeff(), 25) << gap;  // five radii of the spot
      EXPECT_LT(dot.x(), 640 - 25) << gap;
      EXPECT_LT(dot.y(), 480 - 25) << gap;
    }
}

// Distance of a line of sight from a body of revolution or a box about the tool's axis: positive is clear.
double clearance(const geometry::Shape& body, const Vec3& from_T, const Vec3& to_T) {
  double least = 1;
  for (int i = 0; i <= 4000; ++i) {
    const Vec3 p = body.X_FS.inverse() * Vec3(from_T + i / 4000.0 * (to_T - from_T));
    double outside = 1;
    if (const auto* f = std::get_if<geometry::Frustum>(&body.form)) {
      const double radius = f->radius_bottom + (f->radius_top - f->radius_bottom) * p.z() / f->height;
      outside = std::max({p.head<2>().norm() - radius, -p.z(), p.z() - f->height});
    } else if (const auto* c = std::get_if<geometry::Cylinder>(&body.form)) {
      outside = std::max(p.head<2>().norm() - c->radius, std::abs(p.z()) - c->length / 2);
    } else if (const auto* b = std::get_if<geometry::Box>(&body.form)) {
      outside = (p.cwiseAbs() - b->size / 2).maxCoeff();
    }
    least = std::min(least, outside);
  }
  return least;
}

TEST(GapOptics, NoBodyOfTheToolHidesBeamOrDot) {
  const auto& m = hexapod();
  ASSERT_EQ(m.tool.bodies.size(), 3u);
  for (const DotWorld& world :
       {flat(), tilted(-20), tilted(20), bottle(Vec3::UnitX()), bottle(Vec3::UnitY())})
    for (double gap : {0.05e-3, 0.13e-3, 0.5e-3, 1e-3, 1.3e-3, 2e-3, 3e-3, 4e-3}) {
      const Vec3 laser = m.laser.X_TL.translation(), beam = m.laser.X_TL.linear().col(2);
      const auto t = enter(world, upright(gap) * laser, beam);
      ASSERT_TRUE(t);
      const Vec3 dot = laser + *t * beam;
      for (const auto& body : m.tool.bodies) {
        // The beam is 0.15 mm wide at 1/e^2; a beam's radius clear of everything.
        EXPECT_GT(clearance(body, laser, dot), 0.075e-3) << body.name << " clips the beam at gap " << gap;
        EXPECT_GT(clearance(body, dot, m.microscope.X_TC.translation()), 0.075e-3)
            << body.name << " hides the dot at gap " << gap;
      }
    }
}

/// A closed cylinder around y, lying on nothing: `segments` facets, ends capped.
geometry::Mesh cylinder_mesh(double radius, double half_length, int segments) {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < segments; ++i) {
    const double a = 2 * M_PI * i / segments;
    for (double y : {-half_length, half_length})
      vertices.push_back({radius * std::cos(a), y, -radius + radius * std::sin(a)});
  }
  const int low = 2 * segments, high = low + 1;
  vertices.push_back({0, -half_length, -radius});
  vertices.push_back({0, half_length, -radius});
  for (int i = 0; i < segments; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % segments);
    triangles.push_back({a, a + 1, b});
    triangles.push_back({b, a + 1, b + 1});
    triangles.push_back({low, a, b});
    triangles.push_back({high, b + 1, a + 1});
  }
  return {vertices, triangles};
}

TEST(LocalSurface, FindsSlopeAndCurvatureOfTheBottle) {
  const auto mesh = cylinder_mesh(kBottleRadius, 50e-3, 720);
  for (double tilt : {-20.0, 0.0, 20.0}) {
    // Along the normal at this angle, then leaned by 10 degrees along the bottle: the slope must show it.
    const double a = from_deg(tilt);
    const Vec3 normal(std::sin(a), 0, std::cos(a));
    const Vec3 foot = Vec3(0, 0, -kBottleRadius) + kBottleRadius * normal;
    const Mat3 R = shortest_arc_from_z(normal).toRotationMatrix();
    const LocalSurface square = local_surface(mesh, make_pose(R, foot + 0.13e-3 * normal));
    // A fit over 2.5 mm sees 1/R (1 + 5/8 (r/R)^2) at most, 1.6 %, and facets of 0.15 um.
    EXPECT_NEAR(square.curvature(0, 0), -1 / kBottleRadius, 0.02 / kBottleRadius);
    EXPECT_NEAR(square.curvature(1, 1), 0, 0.01 / kBottleRadius);
    EXPECT_NEAR(square.curvature(0, 1), 0, 0.01 / kBottleRadius);
    EXPECT_LT(square.slope.norm(), 1e-3);
    const Mat3 leaned = R * exp_rotation(Vec3(from_deg(10), 0, 0));
    const LocalSurface slanted = local_surface(mesh, make_pose(leaned, foot + 0.13e-3 * normal));
    // Leaning about x by 10 degrees makes T's y climb out of the surface by tan(10 degrees).
    EXPECT_NEAR(slanted.slope.y(), -std::tan(from_deg(10)), 1e-3);
    EXPECT_NEAR(slanted.slope.x(), 0, 1e-3);
  }
}

TEST(LocalSurface, ReadsTheBottlesGapThroughItsMesh) {
  const auto mesh = cylinder_mesh(kBottleRadius, 50e-3, 720);
  const LocalSurface surface = local_surface(mesh, upright(0.13e-3));
  for (double gap : {0.1e-3, 0.13e-3, 0.2e-3, 1e-3}) {
    GapReading reading;
    ASSERT_TRUE(read_gap(hexapod(), surface,
                         dot_at(*exact_dot(hexapod(), bottle(Vec3::UnitY()), upright(gap))), reading));
    EXPECT_NEAR(reading.gap, gap, 0.5e-6);  // a twentieth of one frame's noise
  }
}

std::string error_of(const geometry::Mesh& mesh, const Pose& X_WT) {
  try {
    local_surface(mesh, X_WT);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LocalSurface, RefusesAStartThatHasNoPartBelow) {
  const auto mesh = cylinder_mesh(kBottleRadius, 50e-3, 90);
  EXPECT_THAT(
      error_of(mesh, make_pose(Quat::Identity(), Vec3(0, 0.08, 0))),
      HasSubstr(
          "the tool's axis does not meet the part within 20 mm of the tip at (0.000, 80.000, 0.000) mm"));
  EXPECT_THAT(error_of(mesh, make_pose(Quat::Identity(), Vec3(0, 0, 0.03))),
              HasSubstr("does not meet the part"));
}

TEST(LocalSurface, RefusesAStartAtThePartsEdge) {
  const auto mesh = cylinder_mesh(kBottleRadius, 50e-3, 90);
  EXPECT_THAT(error_of(mesh, make_pose(Quat::Identity(), Vec3(0, 49.5e-3, 0))),
              HasSubstr("the part ends within 2.5 mm"));
}

TEST(LocalSurface, RefusesASurfaceTooRoughToSense) {
  // Sixteen facets stand 15.5 (1 - cos(11.25 degrees)) = 0.3 mm off the circle and meet in edges.
  const auto mesh = cylinder_mesh(kBottleRadius, 50e-3, 16);
  EXPECT_THAT(error_of(mesh, upright(0.13e-3)), HasSubstr("off a smooth surface"));
}

TEST(GapSample, ExpectsTheSpotThatTheOpticsMake) {
  // Waist 0.15 mm at 64 px/mm: a radius of 4.8 px, and 0.7 px of blur (2 sigma 1.4 px) in quadrature.
  EXPECT_NEAR(dot_options(hexapod()).expected_radius_px, std::hypot(4.8, 1.4), 0.01);
}

}  // namespace
}  // namespace understudy::control
