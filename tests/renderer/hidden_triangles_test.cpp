#include "renderer/hidden_triangles.h"

#include <gtest/gtest.h>

namespace understudy::renderer {
namespace {

/// In a picture that looks along -z without perspective: x and y are clip coordinates, z is -1 near, 1 far.
void add(float x, float y, float size, float z, PictureTriangles& triangles) {
  for (const auto& [dx, dy] : {std::pair{0.0f, 0.0f}, {size, 0.0f}, {0.0f, size}}) {
    triangles.corners.push_back(static_cast<std::uint32_t>(triangles.corners.size()));
    for (const float value : {x + dx, y + dy, z, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f})
      triangles.vertices.push_back(value);
  }
}

PictureTriangles triangle(float x, float y, float size, float z) {
  PictureTriangles one;
  add(x, y, size, z, one);
  return one;
}

/// A wall at depth 0.5 before the left half of 100 x 100 pixels, nothing before the right one.
FarthestSeen wall() {
  FarthestSeen seen{100, 100, {}};
  for (int i = 0; i < 100 * 100; ++i) seen.depth.push_back(i % 100 < 50 ? 0.5f : 1.0f);
  return seen;
}

bool is_kept(const PictureTriangles& one, const Eigen::Matrix4f& clip = Eigen::Matrix4f::Identity()) {
  return without_hidden(one, clip, wall()) == one.corners;
}

TEST(HiddenTriangles, WhatLiesBehindTheWallIsLeftOut) {
  EXPECT_FALSE(is_kept(triangle(-0.8f, -0.5f, 0.2f, 0.4f)));  // depth 0.7
  EXPECT_TRUE(is_kept(triangle(-0.8f, -0.5f, 0.2f, -0.4f)));
  EXPECT_TRUE(is_kept(triangle(0.3f, -0.5f, 0.2f, 0.4f)));
}

TEST(HiddenTriangles, TheWallItselfAndWhatLooksOutBesideItStay) {
  EXPECT_TRUE(is_kept(triangle(-0.8f, -0.5f, 0.2f, 0)));
  EXPECT_TRUE(is_kept(triangle(-0.1f, -0.5f, 0.2f, 0.4f)));
  EXPECT_TRUE(is_kept(triangle(-0.21f, -0.5f, 0.2f, 0.4f)));  // its last pixel is the wall's last but one
  EXPECT_FALSE(is_kept(triangle(-0.3f, -0.5f, 0.2f, 0.4f)));
}

TEST(HiddenTriangles, ThoseBesideThePictureAreLeftOutAndThoseThatPassTheEyeStay) {
  EXPECT_FALSE(is_kept(triangle(2, 2, 0.2f, -0.4f)));
  Eigen::Matrix4f behind = Eigen::Matrix4f::Identity();
  behind(3, 3) = 0;
  behind(3, 0) = 1;  // w is x: the triangle's first corner lies in the eye's plane
  EXPECT_TRUE(is_kept(triangle(0, -0.5f, 0.2f, 0.4f), behind));
}

TEST(HiddenTriangles, OrderIsKept) {
  PictureTriangles all;
  add(-0.8f, -0.5f, 0.2f, -0.4f, all);  // near
  add(-0.8f, -0.5f, 0.2f, 0.4f, all);   // behind the wall
  add(0.3f, -0.5f, 0.2f, 0.4f, all);    // beside it
  EXPECT_EQ(without_hidden(all, Eigen::Matrix4f::Identity(), wall()),
            (std::vector<std::uint32_t>{0, 1, 2, 6, 7, 8}));
}

TEST(HiddenTriangles, TrianglesMayShareCorners) {
  PictureTriangles both = triangle(0.3f, -0.5f, 0.2f, 0.4f);
  both.corners = {0, 1, 2, 2, 1, 0};
  EXPECT_EQ(without_hidden(both, Eigen::Matrix4f::Identity(), wall()), both.corners);
}

// Counter-clockwise as +z sees them: 0 1 2 turns its outside there, 2 1 0 its inside.
TEST(HiddenTriangles, InsidesOfClosedSurfacesAreLeftOut) {
  PictureTriangles both = triangle(0.3f, -0.5f, 0.2f, 0.4f);
  both.corners = {0, 1, 2, 2, 1, 0};
  const CornerRange all{0, 6};
  const std::vector<std::uint32_t> outside{0, 1, 2}, inside{2, 1, 0};
  EXPECT_EQ(without_backs(both, all, {0, 0, 1, 0}), outside);     // light from above
  EXPECT_EQ(without_backs(both, all, {0, 0, -1, 0}), inside);     // and from below
  EXPECT_EQ(without_backs(both, all, {5, 0, 0.5f, 1}), outside);  // an eye above the plane of z = 0.4
  EXPECT_EQ(without_backs(both, all, {5, 0, 0.3f, 1}), inside);
}

TEST(HiddenTriangles, OfSurfacesThatMayBeOpenBothSidesStay) {
  PictureTriangles both = triangle(0.3f, -0.5f, 0.2f, 0.4f);
  both.corners = {0, 1, 2, 2, 1, 0};
  EXPECT_EQ(without_backs(both, {0, 3}, {0, 0, 1, 0}), both.corners);
  EXPECT_EQ(without_backs(both, {3, 6}, {0, 0, 1, 0}), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(without_backs(both, {}, {0, 0, 1, 0}), both.corners);
}

}  // namespace
}  // namespace understudy::renderer
