// A glTF 2.0 scene that is being put together: nodes, meshes, one animation.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/frames.h"
#include "report/picture/body_colours.h"

namespace understudy::report {

/// The lengths in a .glb are of 32 bits; its JSON gets what is left.
constexpr std::size_t kGlbBinaryMost = 4'200'000'000;  ///< [bytes]

/// Triangles as they go into a file. One entry a vertex.
struct GltfTriangles {
  std::vector<Vec3> places;                          ///< [m]
  std::vector<Vec3> normals;                         ///< unit; one without a length is written as z
  std::vector<std::array<std::uint8_t, 4>> colours;  ///< linear light; empty: the material's
  std::vector<std::array<int, 3>> triangles;         ///< counter-clockwise outside
};

class GltfScene {
 public:
  /// Throws InputError as soon as what is added takes more than `most` bytes.
  explicit GltfScene(std::size_t most = kGlbBinaryMost) : most_(most) {}

  /// A number to name it by, as from all below. The same name gives the same material.
  int material(const std::string& name, const LinearColour& colour);
  int mesh(const std::string& name, const GltfTriangles& triangles, int material);
  /// Stands at X in its parent; -1: at the top. mesh -1: has none.
  int node(const std::string& name, int parent, const Pose& X = Pose::Identity(), int mesh = -1);
  void set_scale(int node, const Vec3& scale);
  void set_mesh(int node, int mesh);

  /// Values at instants [s]; of instants that 32-bit numbers do not tell apart the last counts. One alone, or
  /// none, is no animation.
  void animate_translation(int node, std::span<const double> times, std::span<const Vec3> values);
  void animate_rotation(int node, std::span<const double> times, std::span<const Quat> values);
  void animate_scale(int node, std::span<const double> times, std::span<const Vec3> values);
  /// From scale 0 to 1 at an instant after `begin`, at once: what viewers take as hidden and shown.
  void show_from(int node, double begin, double time);

  std::size_t keys() const { return keys_; }  ///< of all channels
  std::size_t triangles() const { return triangles_; }
  std::size_t vertices() const { return vertices_; }

  /// The file. `facts` go into the extras of the asset. Nothing can be added behind it.
  std::string glb(const std::string& title, const std::map<std::string, std::string>& facts);

 private:
  int view(std::size_t bytes, int target);
  template <typename Number>
  int accessor(const std::vector<Number>& numbers, int type, int component, int target);
  int floats(const std::vector<float>& numbers, int type, int target = 0, bool limits = false);
  void animate(int node, const char* path, const std::vector<float>& times, const std::vector<float>& values,
               bool stepped);

  std::size_t most_;
  std::size_t keys_ = 0, triangles_ = 0, vertices_ = 0;
  tinygltf::Model model_;
  tinygltf::Animation animation_;
  std::vector<unsigned char> binary_;
  std::map<std::string, int> materials_;
};

}  // namespace understudy::report
