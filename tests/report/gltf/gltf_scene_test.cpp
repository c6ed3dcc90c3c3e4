#include "report/gltf/gltf_scene.h"

#include <tiny_gltf.h>

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::report {
namespace {

using testing::ElementsAre;

GltfTriangles one_triangle() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0)},
          {Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 0)},
          {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}},
          {{0, 1, 2}}};
}

tinygltf::Model read(const std::string& bytes) {
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(&model, &error, &warning,
                                                        reinterpret_cast<const unsigned char*>(bytes.data()),
                                                        static_cast<unsigned>(bytes.size())))
      << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

std::vector<float> floats_of(const tinygltf::Model& model, int accessor) {
  const auto& a = model.accessors[static_cast<std::size_t>(accessor)];
  const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
  std::vector<float> numbers(view.byteLength / sizeof(float));
  std::memcpy(numbers.data(), model.buffers[0].data.data() + view.byteOffset, view.byteLength);
  return numbers;
}

// Header and chunks as glTF 2.0 has them in its section 4.4.
TEST(GltfScene, TheFileIsAHeaderAndTwoChunks) {
  GltfScene scene;
  scene.node("a", -1, Pose::Identity(), scene.mesh("m", one_triangle(), scene.material("red", {1, 0, 0})));
  const std::string bytes = scene.glb("title", {});
  const auto word = [&](std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + at, 4);
    return number;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  const std::size_t second = 20 + word(12);
  EXPECT_EQ(second % 4, 0u);
  EXPECT_EQ(bytes.substr(second + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(second + 8 + word(second), bytes.size());
}

TEST(GltfScene, NodesMeshesAndColoursComeBack) {
  GltfScene scene;
  const int top = scene.node("top", -1, make_pose(Quat(0, 1, 0, 0), Vec3(1, 2, 3)));
  scene.node("below", top, Pose::Identity(),
             scene.mesh("m", one_triangle(), scene.material("red", {1, 0, 0})));
  EXPECT_EQ(scene.material("red", {0, 0, 0}), 0) << "the same name is the same material";
  const tinygltf::Model model = read(scene.glb("title", {{"speed", "1"}}));
  EXPECT_THAT(model.scenes[0].nodes, ElementsAre(0));
  EXPECT_THAT(model.nodes[0].children, ElementsAre(1));
  EXPECT_THAT(model.nodes[0].translation, ElementsAre(1, 2, 3));
  EXPECT_THAT(model.nodes[0].rotation, ElementsAre(1, 0, 0, 0)) << "x y z w";
  EXPECT_TRUE(model.nodes[1].rotation.empty());
  EXPECT_EQ(model.asset.extras.Get("speed").Get<std::string>(), "1");
  const auto& attributes = model.meshes[0].primitives[0].attributes;
  const auto& places = model.accessors[static_cast<std::size_t>(attributes.at("POSITION"))];
  EXPECT_THAT(places.minValues, ElementsAre(0, 0, 0));
  EXPECT_THAT(places.maxValues, ElementsAre(1, 2, 0));
  EXPECT_THAT(floats_of(model, attributes.at("NORMAL")), ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1));
  EXPECT_TRUE(model.accessors[static_cast<std::size_t>(attributes.at("COLOR_0"))].normalized);
}

TEST(GltfScene, ChannelsKeepInstantsThatTheirNumbersTellApart) {
  GltfScene scene;
  const int node = scene.node("a", -1);
  // Beyond 16384 s a 32-bit number counts in steps of 2 ms.
  const std::vector<double> times{0, 20000, 20000.0004, 20001};
  scene.animate_translation(node, times, std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  scene.animate_rotation(node, std::vector<double>{0, 1},
                         std::vector<Quat>{{1, 0, 0, 0}, {-0.6, -0.8, 0, 0}});
  scene.animate_scale(node, std::vector<double>{5}, std::vector<Vec3>{{1, 1, 1}});
  const tinygltf::Model model = read(scene.glb("title", {}));
  ASSERT_EQ(model.animations[0].channels.size(), 2u) << "one instant is no animation";
  EXPECT_EQ(scene.keys(), 5u);
  const auto& samplers = model.animations[0].samplers;
  EXPECT_THAT(floats_of(model, samplers[0].input), ElementsAre(0, 20000, 20001));
  EXPECT_THAT(floats_of(model, samplers[0].output), ElementsAre(0, 0, 0, 2, 0, 0, 3, 0, 0));
  EXPECT_THAT(floats_of(model, samplers[1].output), ElementsAre(0, 0, 0, 1, 0.8f, 0, 0, 0.6f))
      << "the shorter way, x y z w";
}

TEST(GltfScene, WhatIsShownLaterIsScaledAtOnce) {
  GltfScene scene;
  const int node = scene.node("a", -1);
  scene.show_from(node, 1, 4);
  scene.show_from(scene.node("b", -1), 1, 1);  // is there from the beginning
  const tinygltf::Model model = read(scene.glb("title", {}));
  ASSERT_EQ(model.animations[0].samplers.size(), 1u);
  EXPECT_EQ(model.animations[0].samplers[0].interpolation, "STEP");
  EXPECT_THAT(floats_of(model, model.animations[0].samplers[0].input), ElementsAre(1, 4));
  EXPECT_THAT(floats_of(model, model.animations[0].samplers[0].output), ElementsAre(0, 0, 0, 1, 1, 1));
}

TEST(GltfScene, MoreBytesThanTheLengthsTellAreRefused) {
  GltfScene scene(100);
  const int red = scene.material("red", {1, 0, 0});
  try {
    scene.mesh("m", one_triangle(), red);  // 36 of places, 36 of normals, 12 of colours, 6 of corners: 90
    scene.mesh("m", one_triangle(), red);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("more than 100 bytes"));
    EXPECT_EQ(scene.vertices(), 3u);
  }
  static_assert(kGlbBinaryMost < 0xffffffff);
}

}  // namespace
}  // namespace understudy::report
