#include "renderer/laser_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "core/digest.h"
#include "core/error.h"
#include "geometry/box_mesh.h"
#include "renderer/gl_context.h"
#include "tests/renderer/laser_scene.h"

namespace understudy::renderer {
namespace {

std::string digest(const Image& image) {
  return sha256_hex({reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size()});
}

Vec2 dot_of(const LaserScene& scene) {
  Vec2 pixel;
  EXPECT_TRUE(true_dot(scene, pixel));
  return pixel;
}

/// A slab whose top lies at z = `top`, from x0 to x1 and 40 mm along y.
std::shared_ptr<const geometry::Mesh> slab(double x0, double x1, double top) {
  return geometry::box_mesh(Vec3(x0, -20e-3, 0), Vec3(x1, 20e-3, top));
}

TEST(LaserView, SpotHasTheFootprintOfAGaussianBeamOnAPlane) {
  LaserScene scene = clean_scene();
  scene.ambient_level = 0;
  LaserView view;
  const Moments m = moments(view.render(scene, around(dot_of(scene))), 0);
  // Along y the footprint is stretched by 1/cos 40 and seen at full length; along x it is round and
  // foreshortened by cos 45. Blur and the pixel's own 1/12 px^2 add up. Rounding to whole levels drops the
  // rim below half a level of 115: (1 + h) exp(-h) = 2.8 % of the moments, h = ln 230.
  const double scale = scene.camera.focal_px / (scene.X_TC.inverse() * Vec3(0, 0.7e-3, -0.5e-3)).z();
  const double sigma = scene.waist_diameter / 4 * scale, added = 0.7 * 0.7 + 1.0 / 12;
  const double along = std::pow(sigma / std::cos(from_deg(40)), 2) + added;
  const double across = std::pow(sigma * std::cos(from_deg(45)), 2) + added;
  EXPECT_NEAR(m.spread(0, 0), 0.986 * along, 0.014 * along);
  EXPECT_NEAR(m.spread(1, 1), 0.986 * across, 0.014 * across);
  EXPECT_LT((m.centre - dot_of(scene)).norm(), 0.02);
  // The light is that of peak cos 40 at its centre.
  const double flux = 2 * std::numbers::pi * scene.peak_level * std::cos(from_deg(40)) *
                      std::sqrt((along - added) * (across - added));
  EXPECT_NEAR(m.flux, flux, 0.01 * flux);
}

TEST(LaserView, SpotMovesByThePixelsThatTrianglesPredict) {
  LaserView view;
  LaserScene scene = clean_scene();
  scene.ambient_level = 0;
  for (const double gap : {0.05e-3, 0.5e-3, 1.5e-3, 3e-3}) {
    scene.X_WT.translation().z() = gap;
    // By hand: the beam meets the plane z_T = -gap at y = 1.1 mm - gap tan 40.
    const Vec3 p_T(0, 1.1e-3 - gap * std::tan(from_deg(40)), -gap);
    const Vec3 p_C = scene.X_TC.inverse() * p_T;
    const Vec2 pixel = scene.camera.focal_px * p_C.head<2>() / p_C.z() + scene.camera.centre_px;
    EXPECT_LT((dot_of(scene) - pixel).norm(), 1e-9);
    // Rounding to 8 bits scatters the plain centroid by some 0.008 px, and perspective weighs the near half
    // of the spot more: 4 f E[x^2] sin 45 cos 45 / z^2 = 0.0055 px.
    EXPECT_LT((moments(view.render(scene, around(pixel)), 0).centre - pixel).norm(), 0.025) << "gap " << gap;
  }
}

TEST(LaserView, ARegionIsTheCropOfTheWholeFrameBitForBit) {
  LaserView view;
  LaserScene scene = reference_scene();
  scene.aperture_sine = 0.02;
  for (const double k1 : {0.0, -3.0}) {
    scene.camera.k1 = k1;
    const Image whole = view.render(scene, kSensor);
    const Vec2 dot = dot_of(scene);
    const int x = static_cast<int>(dot.x()), y = static_cast<int>(dot.y());
    // Around the dot, cutting through it, at a corner, one pixel.
    for (const Region& r : {Region{x - 64, y - 64, 128, 128}, Region{x - 3, y - 2, 31, 17},
                            Region{600, 0, 40, 50}, Region{x, y, 1, 1}}) {
      const Image part = view.render(scene, r);
      ASSERT_EQ(part.region, r);
      int different = 0;
      for (int j = 0; j < r.height; ++j) {
        for (int i = 0; i < r.width; ++i) different += part.at(i, j) != whole.at(r.x + i, r.y + j);
      }
      EXPECT_EQ(different, 0) << "k1 " << k1 << " region " << r.x << " " << r.y << " " << r.width << " "
                              << r.height;
    }
  }
}

TEST(LaserView, ALensThatDistortsMovesTheDotWithIt) {
  LaserView view;
  LaserScene scene = clean_scene();
  scene.ambient_level = 0;
  scene.X_WT.translation().z() = 2.5e-3;
  scene.camera.centre_px = {-200, 100};  // the dot lies far from the lens's axis
  scene.X_TC = scene.X_TC * make_pose(Quat::Identity(), Vec3(-7e-3, -1.5e-3, 0));
  const Vec2 straight = dot_of(scene);
  scene.camera.k1 = -0.3;
  scene.camera.p1 = 0.01;
  const Vec2 bent = dot_of(scene);
  EXPECT_GT((bent - straight).norm(), 2);
  EXPECT_LT((moments(view.render(scene, around(bent)), 0).centre - bent).norm(), 0.02);
}

TEST(LaserView, EqualScenesGiveEqualBytesInEveryThread) {
  const LaserScene scene = reference_scene();
  const Region region = around(dot_of(scene));
  std::array<std::string, 3> digests;
  std::vector<std::thread> threads;
  for (std::string& d : digests) {
    threads.emplace_back([&scene, &region, &d] {
      LaserView view;
      for (int k = 0; k < 3; ++k) {
        LaserScene other = scene;  // what was drawn before leaves no trace
        other.X_WT.translation().x() += 1e-3 * k;
        view.render(other, region);
      }
      d = digest(view.render(scene, region));
    });
  }
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_EQ(digests[0], digests[2]);
}

TEST(LaserView, DISABLED_PrintsTheDigestOfOneFrame) {
  LaserView view;
  std::printf("digest %s\n", digest(view.render(reference_scene(), kSensor)).c_str());
}

/// llvmpipe reads LP_NUM_THREADS once in a process, so each count gets a process of its own.
std::string digest_with_threads(const char* threads) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "LP_NUM_THREADS=" + std::string(threads) + " '" + self +
                              "' --gtest_also_run_disabled_tests --gtest_filter='*PrintsTheDigestOfOneFrame'";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string line, found;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) {
    if (c != '\n') {
      line.push_back(static_cast<char>(c));
      continue;
    }
    if (line.rfind("digest ", 0) == 0) found = line;
    line.clear();
  }
  pclose(pipe);
  return found;
}

TEST(LaserView, BytesDoNotDependOnTheNumberOfRenderThreads) {
  const std::string none = digest_with_threads("0");
  ASSERT_EQ(none.size(), std::string("digest ").size() + 64);
  EXPECT_EQ(digest_with_threads("2"), none);
  EXPECT_EQ(digest_with_threads("5"), none);
}

TEST(LaserView, NoiseChangesFromFrameToFrameAndSpeckleDoesNot) {
  LaserView view;
  LaserScene scene = reference_scene();
  const Region region = around(dot_of(scene));
  const Image first = view.render(scene, region);
  scene.frame = 1;
  EXPECT_NE(view.render(scene, region).pixels, first.pixels);
  scene.noise = false;
  const Image still = view.render(scene, region);
  scene.frame = 2;
  EXPECT_EQ(view.render(scene, region).pixels, still.pixels);
  scene.seed = 1;
  EXPECT_NE(view.render(scene, region).pixels, still.pixels);
}

TEST(LaserView, AViewThatWasKeptDrawsTheSamePictures) {
  LaserScene other = clean_scene();
  other.camera.width = 320;
  other.part = slab(-20e-3, 20e-3, 2e-3);
  const LaserScene scene = reference_scene();
  const std::string fresh = digest(LaserView().render(scene, kSensor));
  std::string after_same, after_other;
  std::thread([&] {  // what is kept ends with its thread
    keep_laser_views();
    LaserView().render(scene, kSensor);
    const int contexts = GlContext::made();
    after_same = digest(LaserView().render(scene, kSensor));
    LaserView().render(other, kSensor);
    after_other = digest(LaserView().render(scene, kSensor));
    EXPECT_EQ(GlContext::made(), contexts);
  })
      .join();
  EXPECT_EQ(after_same, fresh);
  EXPECT_EQ(after_other, fresh);
}

TEST(LaserView, TheNozzleTakesTheBeamBeforeThePart) {
  LaserScene scene = clean_scene();
  scene.ambient_level = 0;
  // A beam that crosses the tip plane on the axis goes through the nozzle.
  scene.X_TL.translation().y() -= 1.1e-3;
  LaserView view;
  const Image image = view.render(scene, kSensor);
  // Its light lies on the nozzle's flank, at y > 0, and none on the table at y = -gap tan 40.
  const Vec3 on_table(0, -0.5e-3 * std::tan(from_deg(40)), -0.5e-3);
  const auto pixel = scene.camera.project(scene.X_TC.inverse() * on_table);
  const int x = static_cast<int>(pixel->x()), y = static_cast<int>(pixel->y());
  int brightest = 0;
  for (int j = y - 8; j <= y + 8; ++j) {
    for (int i = x - 8; i <= x + 8; ++i) brightest = std::max<int>(brightest, image.at(i, j));
  }
  EXPECT_EQ(brightest, 0);
  Vec2 dot;
  if (true_dot(scene, dot)) {
    EXPECT_GT((dot - *pixel).norm(), 5);
  }
}

TEST(LaserView, ABeamGrazingTheNozzleIsClippedAndAClearOneIsNot) {
  // docs/reference.md#dot-and-gap: clean at 0.6 mm from the flat, clipped (error 0.5 to 0.9 px) within 0.25
  // mm of it.
  LaserView view;
  const auto error_at = [&](double clearance) {
    LaserScene scene = clean_scene();
    scene.ambient_level = 0;
    scene.X_WT.translation().z() = 0.13e-3;
    scene.X_TL.translation().y() += 0.5e-3 + clearance - 1.1e-3;
    Vec2 dot = dot_of(scene);
    return (moments(view.render(scene, around(dot)), 0).centre - dot).norm();
  };
  EXPECT_LT(error_at(0.6e-3), 0.02);
  EXPECT_GT(error_at(0.15e-3), 0.5);
  EXPECT_LT(error_at(0.15e-3), 0.9);
}

TEST(LaserView, WhatStandsBeforeTheCameraHidesTheDot) {
  LaserScene scene = clean_scene();
  const Vec2 dot = dot_of(scene);
  geometry::Shape screen{"screen", geometry::Box{{1e-3, 6e-3, 6e-3}}};
  screen.X_FS.translation() = Vec3(8e-3, 0.5e-3, 8e-3);  // between tip and camera, beside the beam
  scene.tool_bodies.push_back(screen);
  Vec2 hidden;
  EXPECT_FALSE(true_dot(scene, hidden));
  LaserView view;
  const Image image = view.render(scene, around(dot));
  EXPECT_LE(*std::max_element(image.pixels.begin(), image.pixels.end()), 13);  // ambient light of 12
}

TEST(LaserView, ThePartShadesTheTableBehindIt) {
  LaserView view;
  LaserScene scene = clean_scene();
  scene.ambient_level = 0;
  scene.tool_bodies.clear();
  const auto flux = [&] { return moments(view.render(scene, kSensor), 0).flux; };
  scene.X_WT.translation() = Vec3(0, 0, 2.5e-3);
  scene.table = true;
  scene.part = slab(-20e-3, 20e-3, 2e-3);
  const double whole = flux();
  // The edge of the slab cuts the spot in two: half the beam lands on the table. Along x both planes are seen
  // under the same angle, so no light is lost; but the edge of the slab hides some of the lower half, which
  // lies 2 mm deeper and is seen from +x past it.
  scene.part = slab(0, 20e-3, 2e-3);
  const double cut = flux();
  EXPECT_LT(cut, 0.7 * whole);
  EXPECT_GT(cut, 0.4 * whole);
}

TEST(LaserView, AnEmptySceneIsBlack) {
  LaserScene scene = clean_scene();
  scene.table = false;
  scene.tool_bodies.clear();
  LaserView view;
  const Image image = view.render(scene, kSensor);
  EXPECT_EQ(*std::max_element(image.pixels.begin(), image.pixels.end()), 0);
}

TEST(LaserView, TheRegionIsClippedToTheSensor) {
  LaserView view;
  const LaserScene scene = reference_scene();
  EXPECT_EQ(view.render(scene, {-20, 470, 60, 60}).region, (Region{0, 470, 40, 10}));
  const Image nothing = view.render(scene, {700, 0, 10, 10});
  EXPECT_EQ(nothing.width(), 0);
  EXPECT_TRUE(nothing.pixels.empty());
}

TEST(LaserView, ImpossibleOpticsAreNamed) {
  LaserView view;
  LaserScene scene = reference_scene();
  scene.waist_diameter = 0;
  EXPECT_THROW(view.render(scene, kSensor), InputError);
  scene = reference_scene();
  scene.aperture_sine = 0;
  EXPECT_THROW(view.render(scene, kSensor), InputError);
  scene = reference_scene();
  scene.X_WT.translation().x() = std::nan("");
  EXPECT_THROW(view.render(scene, kSensor), InputError);
}

}  // namespace
}  // namespace understudy::renderer
