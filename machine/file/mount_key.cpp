#include "machine/file/mount_key.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr Bounds kPlace{-5000, 5000};
constexpr double kUnitTolerance = 1e-6;  // of a quaternion, as the file's digits leave it

}  // namespace

Pose read_mount(YamlMap& map, const std::string& body, const std::string& where) {
  const std::string quaternion = body + "_quaternion", place = body + "_mm";
  const auto q = map.quantities(quaternion, 4, {-1, 1},
                                ("its rotation in " + where + ": w, x, y, z, of unit length").c_str());
  const Vec3 p = map.vector(place, kPlace, ("its origin in " + where).c_str());
  if (!map.complete()) return Pose::Identity();
  const Quat turn(q[0], q[1], q[2], q[3]);
  if (std::abs(turn.norm() - 1) > kUnitTolerance)
    throw InputError(map.place(quaternion),
                     fmt::format("{} has length {:.7f}, not 1", map.path(quaternion), turn.norm()));
  return make_pose(turn.normalized(), p);
}

std::string vector_text(const Vec3& v, double unit) {
  return fmt::format("[{:.9f}, {:.9f}, {:.9f}]", v.x() / unit, v.y() / unit, v.z() / unit);
}

std::string mount_text(const std::string& body, const Pose& X) {
  const Quat q(X.linear());
  return fmt::format("  {0}_mm: {1}\n  {0}_quaternion: [{2:.12f}, {3:.12f}, {4:.12f}, {5:.12f}]\n", body,
                     vector_text(X.translation(), kMillimetre), q.w(), q.x(), q.y(), q.z());
}

}  // namespace understudy::machine
