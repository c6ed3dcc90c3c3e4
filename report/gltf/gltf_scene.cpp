#include "report/gltf/gltf_scene.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/version.h"

namespace understudy::report {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little endian");

/// Instants that 32-bit numbers tell apart, and which value is at each.
struct Instants {
  std::vector<float> times;
  std::vector<std::size_t> values;
};

Instants told_apart(std::span<const double> times) {
  Instants kept;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const float time = static_cast<float>(times[i]);
    if (!kept.times.empty() && !(time > kept.times.back())) {
      kept.values.back() = i;
      continue;
    }
    kept.times.push_back(time);
    kept.values.push_back(i);
  }
  return kept;
}

void put(const Vec3& v, std::vector<float>& numbers) {
  for (const double x : v) numbers.push_back(static_cast<float>(x));
}

std::vector<float> numbers_of(std::span<const Vec3> values, const std::vector<std::size_t>& chosen) {
  std::vector<float> numbers;
  for (const std::size_t i : chosen) put(values[i], numbers);
  return numbers;
}

std::vector<double> list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::vector<double> list(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

std::size_t width_of(int type) {
  return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
}

}  // namespace

int GltfScene::material(const std::string& name, const LinearColour& colour) {
  const auto [entry, is_new] = materials_.try_emplace(name, static_cast<int>(model_.materials.size()));
  if (!is_new) return entry->second;
  tinygltf::Material material;
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1};
  // Metal mirrors what is around it: without a picture of that, viewers draw it black.
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.6;
  model_.materials.push_back(std::move(material));
  return entry->second;
}

int GltfScene::view(std::size_t bytes, int target) {
  while (binary_.size() % 4 != 0) binary_.push_back(0);
  if (bytes > most_ || binary_.size() > most_ - bytes)
    throw InputError(
        fmt::format("the .glb has more than {} bytes, and its lengths are of 32 bits: fewer slices or "
                    "coarser beads are needed",
                    most_));
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = binary_.size();
  view.byteLength = bytes;
  view.target = target;
  model_.bufferViews.push_back(view);
  return static_cast<int>(model_.bufferViews.size()) - 1;
}

template <typename Number>
int GltfScene::accessor(const std::vector<Number>& numbers, int type, int component, int target) {
  const std::size_t bytes = numbers.size() * sizeof(Number);
  tinygltf::Accessor accessor;
  accessor.bufferView = view(bytes, target);
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = numbers.size() / width_of(type);
  const std::size_t at = binary_.size();
  binary_.resize(at + bytes);
  if (bytes > 0) std::memcpy(binary_.data() + at, numbers.data(), bytes);
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int GltfScene::floats(const std::vector<float>& numbers, int type, int target, bool limits) {
  const int number = accessor(numbers, type, TINYGLTF_COMPONENT_TYPE_FLOAT, target);
  if (!limits) return number;
  const std::size_t width = width_of(type);
  std::vector<double> least(width, std::numeric_limits<double>::infinity()), most(width, -least[0]);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    least[i % width] = std::min(least[i % width], static_cast<double>(numbers[i]));
    most[i % width] = std::max(most[i % width], static_cast<double>(numbers[i]));
  }
  model_.accessors.back().minValues = least;
  model_.accessors.back().maxValues = most;
  return number;
}

int GltfScene::mesh(const std::string& name, const GltfTriangles& triangles, int material) {
  std::vector<float> places, normals;
  for (const Vec3& p : triangles.places) put(p, places);
  for (const Vec3& n : triangles.normals) put(n.norm() > 0.5 ? n : Vec3(0, 0, 1), normals);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = material;
  primitive.attributes["POSITION"] = floats(places, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, true);
  primitive.attributes["NORMAL"] = floats(normals, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
  if (!triangles.colours.empty()) {
    std::vector<std::uint8_t> channels;
    for (const auto& colour : triangles.colours)
      channels.insert(channels.end(), colour.begin(), colour.end());
    primitive.attributes["COLOR_0"] = accessor(
        channels, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TARGET_ARRAY_BUFFER);
    model_.accessors.back().normalized = true;
  }
  const auto corners = [&](auto number) {
    std::vector<decltype(number)> all;
    for (const auto& triangle : triangles.triangles)
      for (const int corner : triangle) all.push_back(static_cast<decltype(number)>(corner));
    return all;
  };
  // The greatest number of each size means "begin anew" and names no vertex.
  primitive.indices =
      triangles.places.size() < std::numeric_limits<std::uint16_t>::max()
          ? accessor(corners(std::uint16_t{}), TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                     TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER)
          : accessor(corners(std::uint32_t{}), TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                     TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Mesh mesh;
  mesh.name = name;
  mesh.primitives.push_back(std::move(primitive));
  model_.meshes.push_back(std::move(mesh));
  vertices_ += triangles.places.size();
  triangles_ += triangles.triangles.size();
  return static_cast<int>(model_.meshes.size()) - 1;
}

int GltfScene::node(const std::string& name, int parent, const Pose& X, int mesh) {
  const int number = static_cast<int>(model_.nodes.size());
  tinygltf::Node node;
  node.name = name;
  node.mesh = mesh;
  const Quat q(X.linear());
  if (!q.isApprox(Quat::Identity(), 0)) node.rotation = list(q.normalized());
  if (!X.translation().isZero(0)) node.translation = list(Vec3(X.translation()));
  model_.nodes.push_back(std::move(node));
  if (parent >= 0) model_.nodes[static_cast<std::size_t>(parent)].children.push_back(number);
  return number;
}

void GltfScene::set_scale(int node, const Vec3& scale) {
  model_.nodes[static_cast<std::size_t>(node)].scale = list(scale);
}

void GltfScene::set_mesh(int node, int mesh) { model_.nodes[static_cast<std::size_t>(node)].mesh = mesh; }

void GltfScene::animate(int node, const char* path, const std::vector<float>& times,
                        const std::vector<float>& values, bool stepped) {
  if (times.size() < 2) return;
  tinygltf::AnimationSampler sampler;
  sampler.interpolation = stepped ? "STEP" : "LINEAR";
  sampler.input = floats(times, TINYGLTF_TYPE_SCALAR, 0, true);
  sampler.output =
      floats(values, values.size() == 4 * times.size() ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3);
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation_.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
  animation_.samplers.push_back(std::move(sampler));
  animation_.channels.push_back(std::move(channel));
  keys_ += times.size();
}

void GltfScene::animate_translation(int node, std::span<const double> times, std::span<const Vec3> values) {
  const Instants at = told_apart(times);
  animate(node, "translation", at.times, numbers_of(values, at.values), false);
}

void GltfScene::animate_scale(int node, std::span<const double> times, std::span<const Vec3> values) {
  const Instants at = told_apart(times);
  animate(node, "scale", at.times, numbers_of(values, at.values), false);
}

void GltfScene::animate_rotation(int node, std::span<const double> times, std::span<const Quat> values) {
  const Instants at = told_apart(times);
  std::vector<float> numbers;
  Quat last = Quat::Identity();
  for (const std::size_t i : at.values) {
    Quat q = values[i].normalized();
    if (i > 0 && q.dot(last) < 0) q.coeffs() = -q.coeffs();  // the shorter way
    last = q;
    for (const double x : list(q)) numbers.push_back(static_cast<float>(x));
  }
  animate(node, "rotation", at.times, numbers, false);
}

void GltfScene::show_from(int node, double begin, double time) {
  const float from = static_cast<float>(begin), at = static_cast<float>(time);
  if (!(at > from)) return;  // it is there from the beginning
  animate(node, "scale", {from, at}, {0, 0, 0, 1, 1, 1}, true);
}

std::string GltfScene::glb(const std::string& title, const std::map<std::string, std::string>& facts) {
  model_.asset.version = "2.0";
  model_.asset.generator = std::string("Understudy ") + kVersion;
  tinygltf::Value::Object extras;
  for (const auto& [name, fact] : facts) extras[name] = tinygltf::Value(fact);
  model_.asset.extras = tinygltf::Value(extras);
  tinygltf::Scene scene;
  scene.name = title;
  std::vector<bool> below(model_.nodes.size(), false);
  for (const tinygltf::Node& node : model_.nodes)
    for (const int child : node.children) below[static_cast<std::size_t>(child)] = true;
  for (std::size_t i = 0; i < below.size(); ++i)
    if (!below[i]) scene.nodes.push_back(static_cast<int>(i));
  model_.scenes.push_back(std::move(scene));
  model_.defaultScene = 0;
  animation_.name = "print";
  if (!animation_.channels.empty()) model_.animations.push_back(std::move(animation_));
  while (binary_.size() % 4 != 0) binary_.push_back(0);
  model_.buffers.resize(1);
  model_.buffers[0].data = std::move(binary_);
  std::ostringstream out;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, out, false, true))
    throw MachineError("the .glb cannot be put together");
  std::string bytes = std::move(out).str();
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(fmt::format("the .glb has {} bytes, more than the {} that its lengths of 32 bits tell",
                                 bytes.size(), std::numeric_limits<std::uint32_t>::max()));
  return bytes;
}

}  // namespace understudy::report
