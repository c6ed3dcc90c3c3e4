#include "renderer/scene_view.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "renderer/scene_geometry.h"

namespace understudy::renderer {
namespace {

PictureScene red_ball() {
  PictureScene s;
  s.shapes.push_back({{"ball", geometry::Sphere{0.05}}, {0.7f, 0.1f, 0.1f}});
  s.eye_W = {0.5, -0.6, 0.35};
  s.width = 200;
  s.height = 150;
  return s;
}

std::array<int, 3> pixel(const Picture& p, int x, int y) {
  const auto i = 3 * static_cast<std::size_t>(y * p.width + x);
  return {p.rgb[i], p.rgb[i + 1], p.rgb[i + 2]};
}

TEST(SceneView, ShowsTheShapeInItsColourOnTheBackground) {
  const Picture p = render_picture(red_ball());
  ASSERT_EQ(p.rgb.size(), 3u * 200 * 150);
  const auto middle = pixel(p, 100, 75), corner = pixel(p, 2, 2);
  EXPECT_GT(middle[0], 1.7 * middle[1]);
  EXPECT_EQ(corner, (std::array<int, 3>{255, 255, 255}));
}

// Mesa ends the process where it does not know the driver.
TEST(SceneView, ADriverThatMesaDoesNotHaveIsRefused) {
  ::setenv("GALLIUM_DRIVER", "nope", 1);
  try {
    (void)render_picture(red_ball());
    FAIL() << "drawn";
  } catch (const MachineError& error) {
    EXPECT_STREQ(error.what(), "GALLIUM_DRIVER is 'nope', not llvmpipe or softpipe: unset it");
  }
  ::setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  EXPECT_NO_THROW(render_picture(red_ball()));
  ::unsetenv("GALLIUM_DRIVER");
}

TEST(SceneView, UpIsUpAndRightIsRight) {
  PictureScene s = red_ball();
  s.shapes.push_back({{"above", geometry::Sphere{0.02}}, {0.05f, 0.05f, 0.8f}});
  s.shapes.back().shape.X_FS.translation() = Vec3(0, 0, 0.1);
  s.shapes.push_back({{"right", geometry::Sphere{0.02}}, {0.05f, 0.7f, 0.05f}});
  // Right of the line of sight, which goes from (0.5, -0.6) to the origin.
  s.shapes.back().shape.X_FS.translation() = 0.12 * Vec3(0.6, 0.5, 0).normalized();
  const Picture p = render_picture(s);
  double blue_row = 0, blue = 0, green_column = 0, green = 0;
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const auto c = pixel(p, x, y);
      if (c[2] > c[0] + 60 && c[2] > c[1] + 60) blue += 1, blue_row += y;
      if (c[1] > c[0] + 60 && c[1] > c[2] + 60) green += 1, green_column += x;
    }
  }
  ASSERT_GT(blue, 20);
  ASSERT_GT(green, 20);
  EXPECT_LT(blue_row / blue, 60);
  EXPECT_GT(green_column / green, 120);
}

TEST(SceneView, TheShapeThrowsASoftShadowOnTheGround) {
  PictureScene s = red_ball();
  s.eye_W = {0, -0.3, 0.8};
  const Picture p = render_picture(s);
  int darkest_grey = 255, shades = 0;
  std::array<bool, 256> seen{};
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const auto c = pixel(p, x, y);
      if (std::abs(c[0] - c[1]) > 3) continue;
      darkest_grey = std::min(darkest_grey, c[0]);
      if (!seen[static_cast<std::size_t>(c[0])]) ++shades;
      seen[static_cast<std::size_t>(c[0])] = true;
    }
  }
  EXPECT_LT(darkest_grey, 225);
  EXPECT_GT(shades, 20);
}

/// [px] Where the shade between two pixels is half-way between theirs.
double half_way(const std::vector<int>& shades, std::size_t dark, std::size_t bright) {
  const double half = 0.5 * (shades[dark] + shades[bright]);
  std::size_t i = dark;
  while (i + 1 < bright && shades[i + 1] < half) ++i;
  return static_cast<double>(i) + 0.5 + (half - shades[i]) / (shades[i + 1] - shades[i]);
}

// The lamp stands over the viewer's left shoulder: seen from above, a plate that hovers throws its shadow to
// the right and down, by its height times the tangents of the lamp's direction (-0.45, 0.35, 0.55 + 0.75).
TEST(SceneView, TheLampsShadowEndsWhereGeometrySaysSo) {
  constexpr double kHigh = 0.05, kHalf = 0.03;  // [m]
  PictureScene s;
  s.shapes = {{{"floor", geometry::Box{{0.4, 0.4, 0.002}}}, {0.6f, 0.6f, 0.6f}},
              {{"plate", geometry::Box{{2 * kHalf, 2 * kHalf, 0.001}}}, {0.6f, 0.6f, 0.6f}}};
  s.shapes[0].shape.X_FS.translation() = Vec3(0, 0, -0.001);
  s.shapes[1].shape.X_FS.translation() = Vec3(0, 0, kHigh);
  s.eye_W = {0, 0, 1};
  s.up_W = {0, 1, 0};
  s.width = 400;
  s.height = 300;
  s.field_of_view = 2 * std::atan(0.15);  // 0.3 m at 1 m: 1 mm a pixel
  const Picture p = render_picture(s);
  std::vector<int> along, down;
  for (int x = 0; x < s.width; ++x) along.push_back(pixel(p, x, 155)[0]);
  for (int y = 0; y < s.height; ++y) down.push_back(pixel(p, 205, y)[0]);
  // The plate itself is seen to end at 30 mm / 0.95 = 32 mm from the middle. Light is computed every 2 pixels
  // and interpolated, two texels of the lamp's map (0.57 mm) above the floor: that moves the end by 0.2 mm. A
  // shade half-way is not light half-way, which moves it by about as much.
  EXPECT_NEAR(half_way(along, 240, 255), 200 + 1e3 * (kHalf + kHigh * 0.45 / 1.3), 0.6);
  EXPECT_NEAR(half_way(down, 188, 201), 150 + 1e3 * (kHalf + kHigh * 0.35 / 1.3), 0.6);
}

TEST(SceneView, EdgesAreSmoothed) {
  PictureScene s = red_ball();
  s.eye_W = {0, 0, 1};  // against the ground's white, from above
  s.up_W = {0, 1, 0};
  s.shapes = {
      {{"plate", geometry::Box{{0.2, 0.1, 0.01}}, make_pose(exp_rotation(Vec3(0, 0, 0.3)), Vec3::Zero())},
       {0.0f, 0.0f, 0.0f}}};
  const Picture p = render_picture(s);
  int between = 0;
  for (int x = 0; x < p.width; ++x) between += pixel(p, x, 40)[0] > 60 && pixel(p, x, 40)[0] < 190;
  for (int y = 0; y < p.height; ++y) between += pixel(p, 100, y)[0] > 60 && pixel(p, 100, y)[0] < 190;
  EXPECT_GT(between, 0);
}

TEST(SceneView, DrawsALineAsATubeOfItsRadius) {
  PictureScene s;
  s.polylines.push_back({{{-0.1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.1, 0, 0}}, {0.1f, 0.1f, 0.8f}, 0.01});
  s.eye_W = {0, -1, 0};
  s.width = 300;
  s.height = 200;
  s.field_of_view = 2 * std::atan(0.1);  // 0.2 m at 1 m: 1 mm a pixel
  const Picture p = render_picture(s);
  int high = 0, wide = 0;
  for (int y = 0; y < 200; ++y) high += pixel(p, 150, y)[2] > pixel(p, 150, y)[0] + 25;
  for (int x = 0; x < 300; ++x) wide += pixel(p, x, 100)[2] > pixel(p, x, 100)[0] + 25;
  EXPECT_NEAR(high, 20, 2);
  EXPECT_NEAR(wide, 220, 3);  // with its round ends
}

/// The ball as triangles that share vertices with normals of their own, a sphere of many facets.
SmoothSurface smooth_ball(const Pose& X_WF) {
  constexpr int kRings = 64, kAround = 128;
  SmoothSurface ball;
  ball.colour = {0.7f, 0.1f, 0.1f};
  ball.X_WF = X_WF;
  for (int i = 0; i <= kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double down = std::numbers::pi * i / kRings, around = 2 * std::numbers::pi * k / kAround;
      const Vec3 out(std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down));
      ball.normals.push_back(out);
      ball.vertices.push_back(0.05 * out + X_WF.inverse(Eigen::Isometry).translation());
    }
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const int a = i * kAround + k, b = i * kAround + (k + 1) % kAround;
      if (i > 0) ball.triangles.push_back({a, a + kAround, b});
      if (i + 1 < kRings) ball.triangles.push_back({b, a + kAround, b + kAround});
    }
  return ball;
}

TEST(SceneView, ASmoothSurfaceIsDrawnAsTheShapeThatItIs) {
  PictureScene shape = red_ball(), surface = red_ball();
  surface.shapes.clear();
  surface.surfaces.push_back(
      smooth_ball(make_pose(exp_rotation(Vec3(0.4, -0.2, 1)), Vec3(0.01, 0.02, -0.03))));
  const Picture a = render_picture(shape), b = render_picture(surface);
  double sum = 0;
  int differ = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int off = std::abs(a.rgb[i] - b.rgb[i]);
    sum += off;
    differ += off > 8 ? 1 : 0;
  }
  EXPECT_LT(sum / static_cast<double>(a.rgb.size()), 0.5);  // of 255: facets of 48 and of 128 sides
  EXPECT_LT(differ, static_cast<int>(a.rgb.size() / 100));
}

TEST(SceneView, EqualScenesGiveEqualBytes) {
  EXPECT_EQ(render_picture(red_ball()).rgb, render_picture(red_ball()).rgb);
}

TEST(SceneView, AnEmptySceneIsBackground) {
  PictureScene s;
  s.eye_W = {1, 1, 1};
  s.width = 20;
  s.height = 10;
  for (const auto v : render_picture(s).rgb) EXPECT_EQ(v, 255);
}

TEST(SceneView, ACameraThatLooksNowhereIsRefused) {
  PictureScene s = red_ball();
  s.eye_W = s.target_W;
  EXPECT_THROW(render_picture(s), InputError);
  s = red_ball();
  s.eye_W = {0, 0, 1};  // along up
  EXPECT_THROW(render_picture(s), InputError);
  s = red_ball();
  s.width = 0;
  EXPECT_THROW(render_picture(s), InputError);
}

TEST(SkyDirections, AreEvenOverTheHalfSphere) {
  // Their mean cosine to the zenith is 1/2, their horizontal mean 0.
  Vec3 mean = Vec3::Zero();
  for (const Vec3& d : sky_directions(48)) mean += d / 48;
  EXPECT_NEAR(mean.z(), 0.5, 1e-9);
  EXPECT_LT(mean.head<2>().norm(), 0.03);
}

}  // namespace
}  // namespace understudy::renderer
