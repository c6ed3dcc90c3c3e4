#include "renderer/calibration_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"

namespace understudy::renderer {
namespace {

Exposure clean() {
  Exposure e;
  e.noise = false;
  e.gain = 220;
  e.ambient_level = 10;
  return e;
}

/// 150 mm are seen at 400 mm (docs/reference.md#two-cameras).
Camera straight_lens() {
  return {.width = 1600, .height = 1200, .focal_px = 4267, .centre_px = {799.5, 599.5}};
}

/// A sheet that faces the camera at `depth` [m].
BoardScene board_at(double depth) {
  BoardScene s;
  s.camera = straight_lens();
  s.columns = 12;
  s.rows = 9;
  s.square = 10e-3;
  s.margin = 2.5e-3;
  s.X_CG = Pose(Eigen::Translation3d(0, 0, depth));
  return s;
}

Camera bent_lens() {
  Camera c = straight_lens();
  c.k1 = -0.12, c.k2 = 0.15, c.p1 = 4e-4, c.p2 = -3e-4;
  return c;
}

Region square_around(const Vec2& p, int half) {
  return {static_cast<int>(std::lround(p.x())) - half, static_cast<int>(std::lround(p.y())) - half,
          2 * half + 1, 2 * half + 1};
}

double gaussian(double d, double sigma) { return std::exp(-0.5 * d * d / (sigma * sigma)); }

/// Sixteen by sixteen points a pixel, each lit as geometry says, gathered by a Gaussian: slow and obvious.
template <typename Lit>
double pixel_by_brute_force(int x, int y, double blur, const Lit& lit) {
  constexpr int kPoints = 16, kReach = 3;
  double sum = 0, weight = 0;
  for (int j = -kReach * kPoints; j < (kReach + 1) * kPoints; ++j) {
    for (int i = -kReach * kPoints; i < (kReach + 1) * kPoints; ++i) {
      const double dx = (i + 0.5) / kPoints - 0.5, dy = (j + 0.5) / kPoints - 0.5;
      // The pixel's box and the blur, over its inner points.
      double w = 0;
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) {
          w += gaussian(std::hypot(dx - (k - 1.5) / 4, dy - (l - 1.5) / 4), blur);
        }
      }
      sum += w * lit(Vec2(x + dx, y + dy));
      weight += w;
    }
  }
  return sum / weight;
}

/// Light of a board at a pixel's ray, met by bisection where the sheet is bowed.
double board_lit(const BoardScene& s, const Vec2& p) {
  const Pose X_GC = s.X_CG.inverse();
  const Vec3 way((p.x() - s.camera.centre_px.x()) / s.camera.focal_px,
                 (p.y() - s.camera.centre_px.y()) / s.camera.focal_px, 1);
  const Vec3 o = X_GC.translation(), d = X_GC.linear() * way;
  const auto above = [&](double t) {
    const Vec3 at = o + t * d;
    const double X = at.x() / (0.5 * s.square * (s.columns - 1)),
                 Y = at.y() / (0.5 * s.square * (s.rows - 1));
    return at.z() - (s.bow[0] * X * X + s.bow[1] * X * Y + s.bow[2] * Y * Y);
  };
  double near = 0.9 * -o.z() / d.z(), far = 1.1 * -o.z() / d.z();
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    (above(near) * above(middle) <= 0 ? far : near) = middle;
  }
  const Vec3 at = o + near * d;
  const double column = std::floor(at.x() / s.square + 0.5 * (s.columns + 1));
  const double row = std::floor(at.y() / s.square + 0.5 * (s.rows + 1));
  const bool inked = static_cast<int>(column + row) % 2 == 0;
  const double falloff = std::pow(way.squaredNorm(), -2);
  return s.exposure.ambient_level + s.exposure.gain * falloff * (inked ? s.ink : 1.0);
}

// Without a lens's distortion, so that a point's ray needs no iteration of ours. 8 bits round by 0.5; the
// brute force cuts the Gaussian at 4 sigma and sums in steps of a sixteenth: 1 grey level of 200. A bow of
// 0.3 mm moves the outer corners by 0.6 px, some 40 grey levels.
TEST(CalibrationView, ABoardsCornerIsLitAsGeometrySays) {
  CalibrationView view;
  BoardScene s = board_at(385e-3);
  s.X_CG = s.X_CG * make_pose(exp_rotation(Vec3(0.02, -0.03, 0.2)), Vec3(0.3e-3, 0.1e-3, 0));
  s.exposure = clean();
  for (const Vec3& bow : {Vec3(0, 0, 0), Vec3(0.3e-3, -0.2e-3, 0.1e-3)}) {
    s.bow = bow;
    const auto corners = true_corners(s);
    const auto lit = [&](const Vec2& p) { return board_lit(s, p); };
    for (const std::size_t corner : {0u, 40u, 107u}) {
      const Image image = view.render(s, square_around(*corners[corner], 3));
      for (int y = 0; y < 7; y += 2) {
        for (int x = 0; x < 7; x += 2) {
          const double expected =
              pixel_by_brute_force(image.region.x + x, image.region.y + y, s.exposure.blur_px, lit);
          EXPECT_NEAR(image.at(x, y), expected, 1.6) << "corner " << corner << " pixel " << x << ' ' << y;
        }
      }
    }
  }
}

// Light missing from the backdrop is the disc's area and its first moments its centre: both from closed
// forms.
TEST(CalibrationView, ASpheresOutlineHasItsAreaAndItsCentre) {
  CalibrationView view;
  TargetScene s;
  s.camera = straight_lens();
  s.exposure = clean();
  s.exposure.ambient_level = 0;
  s.exposure.noise = true;  // one grey level: without it, rounding would be alike over whole bands
  s.exposure.full_well = 40000;
  s.exposure.read_noise = 0;
  s.radius = 5e-3;
  s.albedo = 0;
  for (const Vec3& c : {Vec3(3e-3, -2e-3, 0.41), Vec3(60e-3, 45e-3, 0.38)}) {
    s.centres_C = {c};
    const Vec2 centre = *true_outline_centre(s.camera, c, s.radius);
    const Image image = view.render(s, square_around(centre, 80));
    double area = 0, x_moment = 0, y_moment = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const double u = (image.region.x + x - s.camera.centre_px.x()) / s.camera.focal_px;
        const double v = (image.region.y + y - s.camera.centre_px.y()) / s.camera.focal_px;
        const double missing = 1 - image.at(x, y) / (s.exposure.gain / std::pow(1 + u * u + v * v, 2));
        area += missing;
        x_moment += missing * (image.region.x + x);
        y_moment += missing * (image.region.y + y);
      }
    }
    // Semi-axes f R / sqrt(Z^2 - R^2) and that times sqrt(|c|^2 - R^2) / sqrt(Z^2 - R^2).
    const double b2 = std::pow(s.camera.focal_px * s.radius, 2) / (c.z() * c.z() - s.radius * s.radius);
    const double stretch =
        std::sqrt((c.squaredNorm() - s.radius * s.radius) / (c.z() * c.z() - s.radius * s.radius));
    const double expected = std::numbers::pi * b2 * stretch;
    // Four sigma of one grey level of 220 over 26 000 pixels, at 46 px of arm for the moments.
    EXPECT_NEAR(area, expected, 3.5) << c.transpose();
    EXPECT_NEAR(x_moment / area, centre.x(), 0.02);
    EXPECT_NEAR(y_moment / area, centre.y(), 0.02);
  }
}

TEST(CalibrationView, TheOutlinesCentreLiesOutsideOfTheSpheres) {
  const Camera c = straight_lens();
  const Vec3 p(75e-3, 0, 0.4);
  // f X / Z (Z^2 / (Z^2 - R^2) - 1) = 800 px * 25 / 159975.
  EXPECT_NEAR(true_outline_centre(c, p, 5e-3)->x() - true_sphere_centre(c, p)->x(), 0.12503, 1e-4);
  EXPECT_FALSE(true_outline_centre(c, Vec3(0, 0, -0.1), 5e-3));
}

TEST(CalibrationView, APixelDoesNotDependOnTheRegionAndBytesRepeat) {
  CalibrationView view, other;
  BoardScene board = board_at(400e-3);
  board.camera = bent_lens();
  const Image large = view.render(board, {300, 200, 300, 260}),
              small = other.render(board, {411, 317, 64, 50});
  for (int y = 0; y < small.height(); ++y) {
    for (int x = 0; x < small.width(); ++x)
      ASSERT_EQ(small.at(x, y), large.at(x + 111, y + 117)) << x << ' ' << y;
  }
  EXPECT_EQ(view.render(board, large.region).pixels, large.pixels);
  board.exposure.frame = 1;
  EXPECT_NE(view.render(board, large.region).pixels, large.pixels);  // other noise
  EXPECT_TRUE(view.render(board, {2000, 0, 10, 10}).pixels.empty());
}

TEST(CalibrationView, RefusesScenesWithoutAPicture) {
  CalibrationView view;
  const auto message = [&](auto scene) -> std::string {
    try {
      view.render(scene, {0, 0, 8, 8});
    } catch (const InputError& e) {
      return e.what();
    }
    return "drawn";
  };
  BoardScene sharp = board_at(375e-3), fisheye = sharp;
  sharp.exposure.blur_px = 0;
  EXPECT_NE(message(sharp).find("blur [px] is 0.0"), std::string::npos);
  fisheye.camera.k1 = -3;
  EXPECT_NE(message(fisheye).find("distortion"), std::string::npos);
  TargetScene behind;
  behind.camera = straight_lens();
  behind.radius = 5e-3;
  behind.centres_C = {Vec3(0, 0, -0.6)};
  EXPECT_NE(message(behind).find("target distance"), std::string::npos);
}

}  // namespace
}  // namespace understudy::renderer
