// What the readers and writers of as-built files share.
#pragma once

#include <string>
#include <type_traits>

#include "core/yaml/yaml_map.h"

namespace understudy::sim {

constexpr Bounds kPlaceBounds{-5000, 5000};  // [mm]
constexpr double kUnitTolerance = 1e-6;      // of a direction's length, as the file's digits leave it

template <typename Value>
void read_if_given(YamlMap& map, const std::string& key, Bounds bounds, const char* about, Value& value) {
  if (!map.has(key)) return;
  if constexpr (std::is_same_v<Value, Vec3>)
    value = map.vector(key, bounds, about);
  else
    value = map.quantity(key, bounds, about);
}

/// Keys of a position [mm] and of a quaternion; `about` says of what, in which frame.
struct MountKeys {
  std::string position, rotation;
  const char* about;
};
void read_mount(YamlMap& map, const MountKeys& keys, Pose& mount);

std::string vector_text(const Vec3& v, double unit);
std::string rotation_text(const Pose& X);  ///< quaternion w, x, y, z

}  // namespace understudy::sim
