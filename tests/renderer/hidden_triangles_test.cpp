#include "renderer/hidden_triangles.h"

#include <gtest/gtest.h>

namespace understudy::renderer {
namespace {

constexpr std::size_t kTriangle = 27;

/// In a picture that looks along -z without perspective: x and y are clip coordinates, z is -1 near, 1 far.
std::vector<float> triangle(float x, float y, float size, float z) {
  std::vector<float> vertices;
  for (const auto& [dx, dy] : {std::pair{0.0f, 0.0f}, {size, 0.0f}, {0.0f, size}})
    for (const float value : {x + dx, y + dy, z, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f})
      vertices.push_back(value);
  return vertices;
}

/// A wall at depth 0.5 before the left half of 100 x 100 pixels, nothing before the right one.
FarthestSeen wall() {
  FarthestSeen seen{100, 100, {}};
  for (int i = 0; i < 100 * 100; ++i) seen.depth.push_back(i % 100 < 50 ? 0.5f : 1.0f);
  return seen;
}

bool is_kept(const std::vector<float>& vertices, const Eigen::Matrix4f& clip = Eigen::Matrix4f::Identity()) {
  return without_hidden(vertices, clip, wall()) == vertices;
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
  const auto near = triangle(-0.8f, -0.5f, 0.2f, -0.4f), far = triangle(-0.8f, -0.5f, 0.2f, 0.4f),
             beside = triangle(0.3f, -0.5f, 0.2f, 0.4f);
  std::vector<float> all;
  for (const auto& part : {near, far, beside}) all.insert(all.end(), part.begin(), part.end());
  const auto kept = without_hidden(all, Eigen::Matrix4f::Identity(), wall());
  ASSERT_EQ(kept.size(), 2 * kTriangle);
  EXPECT_TRUE(std::equal(near.begin(), near.end(), kept.begin()));
  EXPECT_TRUE(std::equal(beside.begin(), beside.end(), kept.begin() + kTriangle));
}

}  // namespace
}  // namespace understudy::renderer
