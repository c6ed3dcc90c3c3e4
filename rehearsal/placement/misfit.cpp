#include "rehearsal/placement/misfit.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "rehearsal/placement/checked_path.h"
#include "rehearsal/placement/path_poses.h"
#include "rehearsal/placement/placement_task.h"
#include "rehearsal/placement/pose_shares.h"

namespace understudy::rehearsal {
namespace {

constexpr std::size_t kLooks = 200;

}  // namespace

std::string misfit(const RehearsalRequest& request) {
  PlacementTask task = read_placement_task(request);
  ProgramPath& path = task.path;
  std::vector<PathPose> some;
  for (const std::size_t i : spread_poses(path.poses, kLooks)) some.push_back(path.poses[i]);
  path.poses = some;
  path.connected.assign(some.size(), false);
  path.height = from_mm(request.dialect.place_mm[2]);
  Stand stand{{0, 0}, from_deg(request.dialect.turn_deg), from_deg(request.dialect.spin_deg)};
  stand.middle = Vec2(from_mm(request.dialect.place_mm[0]), from_mm(request.dialect.place_mm[1])) +
                 Eigen::Rotation2Dd(stand.turn) * path.middle();
  PoseShares shares(task.machine, task.obstacle);
  const CheckedPath checked = check_path(shares, path, stand);
  const auto least = static_cast<std::size_t>(std::min_element(checked.shares.begin(), checked.shares.end()) -
                                              checked.shares.begin());
  if (checked.shares[least] >= 0) return "";
  const CheckedPath::Worst& worst = checked.worst[least];
  return fmt::format("{} (line {})", shares.broken(least, path.placed(worst.pose, stand), worst.axes),
                     worst.pose.line);
}

}  // namespace understudy::rehearsal
