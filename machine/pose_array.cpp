#include "machine/pose_array.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/assert.h"
#include "core/parallel.h"
#include "kinematics/hexapod/hexapod_batch.h"
#include "machine/pose_table.h"

namespace understudy::machine {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;
using kinematics::StrutLengths;

constexpr std::size_t kBlock = 512;       // rows whose statuses are kept at a time
constexpr std::size_t kShare = 16384;     // rows that are worth handing to a thread
constexpr std::size_t kSlowShare = 1024;  // of solutions one by one, and of forward kinematics
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::uint8_t byte(SolveStatus status) { return static_cast<std::uint8_t>(status); }

using Rows = std::function<void(std::size_t begin, std::size_t end)>;

/// Runs work(begin, end) over [0, count) in shares, which are the same whatever the number of threads.
void in_shares(std::size_t count, std::size_t share, int threads, const Rows& work) {
  const int wanted = threads > 0 ? threads : hardware_threads();
  in_parallel((count + share - 1) / share, wanted,
              [&](std::size_t n) { work(n * share, std::min(count, (n + 1) * share)); });
}

/// Rows [begin, end) of an array of poses and of what answers them.
struct Part {
  std::span<const double> poses;
  std::span<double> axes;
  StatusBytes status;
};

/// The struts as seen from W, where the rows stand: their lengths are the same.
kinematics::HexapodGeometry in_world(const MachineDescription& machine) {
  kinematics::HexapodGeometry geometry = machine.hexapod().geometry;
  for (Vec3& joint : geometry.base_joint) joint = machine.X_WB * joint;
  return geometry;
}

/// Lengths go straight to where they shall stand.
void solve_struts(const kinematics::HexapodGeometry& geometry_W, const Part& part) {
  static_assert(sizeof(StrutLengths) == kinematics::kStruts * sizeof(double));
  std::array<SolveStatus, kBlock> answers;
  const std::size_t rows = part.status.size();
  auto* const lengths = reinterpret_cast<StrutLengths*>(part.axes.data());
  for (std::size_t at = 0; at < rows; at += kBlock) {
    const std::size_t size = std::min(kBlock, rows - at);
    kinematics::inverse_rows(geometry_W, part.poses.subspan(kPoseNumbers * at), std::span(lengths + at, size),
                             std::span(answers).first(size));
    for (std::size_t n = 0; n < size; ++n) {
      part.status[at + n] = byte(answers[n]);
      if (answers[n] != SolveStatus::ok) lengths[at + n].fill(kNone);
    }
  }
}

void solve_one_by_one(const kinematics::Mechanism& mechanism, const Pose& X_BW, const Part& part) {
  const auto count = static_cast<std::size_t>(mechanism.axis_count());
  for (std::size_t n = 0; n < part.status.size(); ++n) {
    Pose X_WT;
    const std::span<double> axes = part.axes.subspan(count * n, count);
    const SolveStatus status = kinematics::read_pose(&part.poses[kPoseNumbers * n], X_WT)
                                   ? mechanism.inverse(X_BW * X_WT, {}, axes)
                                   : SolveStatus::bad_input;
    part.status[n] = byte(status);
    if (status != SolveStatus::ok) std::ranges::fill(axes, kNone);
  }
}

bool has_plain_struts(const MachineDescription& machine) {
  return !machine.is_chain() && machine.hexapod().screw_rotation != ScrewRotation::compensated;
}

void check_sizes(std::size_t poses, std::size_t axes, std::size_t rows, std::size_t axis_count) {
  UNDERSTUDY_ASSERT(poses == kPoseNumbers * rows && axes == axis_count * rows, "arrays of one length");
}

}  // namespace

void axes_of_poses(const MachineDescription& machine, std::span<const double> poses, std::span<double> axes,
                   StatusBytes status, int threads) {
  const auto mechanism = machine.make_mechanism();
  const auto count = static_cast<std::size_t>(mechanism->axis_count());
  check_sizes(poses.size(), axes.size(), status.size(), count);
  const bool struts = has_plain_struts(machine);
  const auto geometry_W = struts ? in_world(machine) : kinematics::HexapodGeometry{};
  const Pose X_BW = machine.X_WB.inverse();
  in_shares(status.size(), struts ? kShare : kSlowShare, threads, [&](std::size_t begin, std::size_t end) {
    const std::size_t rows = end - begin;
    const Part part{poses.subspan(kPoseNumbers * begin, kPoseNumbers * rows),
                    axes.subspan(count * begin, count * rows), status.subspan(begin, rows)};
    struts ? solve_struts(geometry_W, part) : solve_one_by_one(*mechanism, X_BW, part);
  });
}

void poses_of_axes(const MachineDescription& machine, std::span<const double> axes, std::span<double> poses,
                   StatusBytes status, int threads) {
  const auto count = static_cast<std::size_t>(machine.make_mechanism()->axis_count());
  check_sizes(poses.size(), axes.size(), status.size(), count);
  in_shares(status.size(), kSlowShare, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<AxisVector> rows(end - begin);
    for (std::size_t n = begin; n < end; ++n) std::copy_n(&axes[count * n], count, rows[n - begin].begin());
    const std::vector<SolvedPose> solved = solve_poses(machine, rows);
    for (std::size_t n = begin; n < end; ++n) {
      const SolvedPose& one = solved[n - begin];
      status[n] = byte(one.status);
      if (one.status == SolveStatus::ok)
        kinematics::write_pose(machine.X_WB * one.X_BT, &poses[kPoseNumbers * n]);
      else
        std::fill_n(&poses[kPoseNumbers * n], kPoseNumbers, kNone);
    }
  });
}

}  // namespace understudy::machine
