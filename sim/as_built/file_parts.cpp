#include "sim/as_built/file_parts.h"

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::sim {

void read_mount(YamlMap& map, const MountKeys& keys, Pose& mount) {
  Vec3 p = mount.translation();
  read_if_given(map, keys.position, kPlaceBounds, keys.about, p);
  mount.translation() = p;
  if (!map.has(keys.rotation)) return;
  const auto q = map.quantities(keys.rotation, 4, {-1, 1}, "its rotation: w, x, y, z, of unit length");
  if (map.recording()) return;
  const Quat turn(q[0], q[1], q[2], q[3]);
  if (std::abs(turn.norm() - 1) > kUnitTolerance)
    throw InputError(map.place(keys.rotation),
                     fmt::format("{} has length {:.7f}, not 1", map.path(keys.rotation), turn.norm()));
  mount = make_pose(turn.normalized(), p);
}

std::string vector_text(const Vec3& v, double unit) {
  return fmt::format("[{}, {}, {}]", v.x() / unit, v.y() / unit, v.z() / unit);
}

std::string rotation_text(const Pose& X) {
  const Quat q(X.linear());
  return fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z());
}

}  // namespace understudy::sim
