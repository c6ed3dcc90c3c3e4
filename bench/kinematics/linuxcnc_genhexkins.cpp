#include "bench/kinematics/linuxcnc_genhexkins.h"

#include <dlfcn.h>

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>

#include "core/units.h"

namespace {

constexpr const char* kModule = "/usr/lib/linuxcnc/modules/genhexkins.so";

/// The pins that the module asked for, as the one HAL component of this process.
std::map<std::string, volatile double*>& float_pins() {
  static std::map<std::string, volatile double*> pins;
  return pins;
}

std::string formatted(const char* format, std::va_list arguments) {
  char text[128];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

template <class Value>
int new_pin(volatile Value** place) {
  *place = new Value{};  // for the life of the process, as HAL memory is
  return 0;
}

}  // namespace

// What the module expects of LinuxCNC's hardware abstraction layer.
extern "C" {
int hal_init(const char*) { return 1; }
int hal_exit(int) { return 0; }
int hal_ready(int) { return 0; }
void* hal_malloc(long size) { return std::calloc(1, static_cast<std::size_t>(size)); }
int hal_pin_float_newf(int, volatile double** place, int, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const std::string name = formatted(format, arguments);
  va_end(arguments);
  new_pin(place);
  float_pins()[name] = *place;
  return 0;
}
int hal_pin_u32_newf(int, volatile unsigned** place, int, const char*, ...) { return new_pin(place); }
int hal_pin_s32_new(const char*, int, volatile int** place, int) { return new_pin(place); }
int hal_pin_bit_new(const char*, int, volatile bool** place, int) { return new_pin(place); }
int hal_pin_bit_newf(int, volatile bool** place, int, const char*, ...) { return new_pin(place); }
void rtapi_print(const char*, ...) {}
void rtapi_print_msg(int, const char*, ...) {}
}

namespace understudy::bench {

std::unique_ptr<Genhexkins> Genhexkins::load(const kinematics::HexapodGeometry& geometry,
                                             std::string& reason) {
  void* library = dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    reason = dlerror();
    return nullptr;
  }
  auto peer = std::make_unique<Genhexkins>();
  peer->inverse_ = reinterpret_cast<Inverse>(dlsym(library, "kinematicsInverse"));
  peer->forward_ = reinterpret_cast<Forward>(dlsym(library, "kinematicsForward"));
  const auto start = reinterpret_cast<int (*)()>(dlsym(library, "rtapi_app_main"));
  if (peer->inverse_ == nullptr || peer->forward_ == nullptr || start == nullptr || start() != 0) {
    reason = std::string(kModule) + " does not start";
    return nullptr;
  }
  const auto set = [&](const std::string& joint, std::size_t i, const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      const std::string name = "genhexkins." + joint + "." + std::to_string(i) + "." + "xyz"[k];
      const auto pin = float_pins().find(name);
      if (pin == float_pins().end()) {
        reason = "it has no pin " + name;
        return false;
      }
      *pin->second = to_mm(p[k]);
    }
    return true;
  };
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    if (!set("base", i, geometry.base_joint[i]) || !set("platform", i, geometry.platform_joint[i]))
      return nullptr;
  for (const char* offset : {"genhexkins.spindle-offset", "genhexkins.tool-offset", "genhexkins.screw-lead"})
    if (const auto pin = float_pins().find(offset); pin != float_pins().end()) *pin->second = 0;
  return peer;
}

Genhexkins::World Genhexkins::world_of(const Pose& X_BT) {
  const Mat3 R = X_BT.linear();  // Rz(yaw) Ry(pitch) Rx(roll)
  World world;
  world.x = to_mm(X_BT.translation().x());
  world.y = to_mm(X_BT.translation().y());
  world.z = to_mm(X_BT.translation().z());
  world.a = to_deg(std::atan2(R(2, 1), R(2, 2)));
  world.b = to_deg(std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))));
  world.c = to_deg(std::atan2(R(1, 0), R(0, 0)));
  return world;
}

Pose Genhexkins::pose_of(const World& world) {
  const Mat3 R = (Eigen::AngleAxisd(from_deg(world.c), Vec3::UnitZ()) *
                  Eigen::AngleAxisd(from_deg(world.b), Vec3::UnitY()) *
                  Eigen::AngleAxisd(from_deg(world.a), Vec3::UnitX()))
                     .toRotationMatrix();
  return make_pose(R, Vec3(from_mm(world.x), from_mm(world.y), from_mm(world.z)));
}

}  // namespace understudy::bench
