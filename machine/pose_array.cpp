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

constexpr std::size_t kBlock = 128;    // rows converted at a time: their poses stay in the nearest cache
constexpr std::size_t kShare = 16384;  // rows that are worth handing to a thread
constexpr std::size_t kForwardShare = 1024;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::uint8_t byte(SolveStatus status) { return static_cast<std::uint8_t>(status); }

using Rows = std::function<void(std::size_t begin, std::size_t end)>;

/// Runs work(begin, end) over [0, count) in shares, which are the same whatever the number of threads.
void in_shares(std::size_t count, std::size_t share, int threads, const Rows& work) {
  const int wanted = threads > 0 ? threads : hardware_threads();
  in_parallel((count + share - 1) / share, wanted,
              [&](std::size_t n) { work(n * share, std::min(count, (n + 1) * share)); });
}

struct Block {
  std::array<Pose, kBlock> X_BT;
  std::array<bool, kBlock> read;
};

void read_block(std::span<const double> poses, const Pose& X_BW, std::size_t size, Block& block) {
  for (std::size_t n = 0; n < size; ++n) {
    Pose X_WT = Pose::Identity();
    block.read[n] = read_pose(&poses[kPoseNumbers * n], X_WT);
    block.X_BT[n] = X_BW * X_WT;
  }
}

void put_status(const Block& block, std::size_t size, std::size_t axis_count, double* axes,
                std::uint8_t* status) {
  for (std::size_t n = 0; n < size; ++n) {
    if (!block.read[n]) status[n] = byte(SolveStatus::bad_input);
    if (status[n] != byte(SolveStatus::ok)) std::fill_n(axes + axis_count * n, axis_count, kNone);
  }
}

/// Lengths go straight to where they shall stand.
void solve_struts(const HexapodModel& hexapod, const Block& block, std::size_t size, double* axes,
                  std::uint8_t* status) {
  static_assert(sizeof(StrutLengths) == kinematics::kStruts * sizeof(double));
  std::array<SolveStatus, kBlock> answers;
  const std::span lengths(reinterpret_cast<StrutLengths*>(axes), size);
  kinematics::inverse_batch(hexapod.geometry, std::span(block.X_BT).first(size), lengths,
                            std::span(answers).first(size), 1);
  for (std::size_t n = 0; n < size; ++n) status[n] = byte(answers[n]);
}

void solve_axes_one_by_one(const kinematics::Mechanism& mechanism, const Block& block, std::size_t size,
                           double* axes, std::uint8_t* status) {
  const auto count = static_cast<std::size_t>(mechanism.axis_count());
  for (std::size_t n = 0; n < size; ++n)
    status[n] = byte(mechanism.inverse(block.X_BT[n], {}, std::span(axes + count * n, count)));
}

bool has_plain_struts(const MachineDescription& machine) {
  return !machine.is_chain() && machine.hexapod().screw_rotation != ScrewRotation::compensated;
}

void check_sizes(std::size_t poses, std::size_t axes, std::size_t rows, std::size_t axis_count) {
  UNDERSTUDY_ASSERT(poses == kPoseNumbers * rows && axes == axis_count * rows, "arrays of one length");
}

}  // namespace

bool read_pose(const double* row, Pose& X) {
  const double w = row[3], x = row[4], y = row[5], z = row[6];
  const double squared = w * w + x * x + y * y + z * z;
  if (!(std::abs(std::sqrt(squared) - 1) <= kUnitQuaternion)) return false;
  const double s = 2 / squared;  // of a quaternion of nearly unit length
  X.matrix() << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y), row[0],  //
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x), row[1],            //
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y), row[2],            //
      0, 0, 0, 1;
  return true;
}

void write_pose(const Pose& X, double* row) {
  Quat q(X.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  const Vec3 p = X.translation();
  std::copy_n(p.data(), 3, row);
  row[3] = q.w();
  std::copy_n(q.vec().data(), 3, row + 4);
}

void axes_of_poses(const MachineDescription& machine, std::span<const double> poses, std::span<double> axes,
                   StatusBytes status, int threads) {
  const auto mechanism = machine.make_mechanism();
  const auto count = static_cast<std::size_t>(mechanism->axis_count());
  check_sizes(poses.size(), axes.size(), status.size(), count);
  const Pose X_BW = machine.X_WB.inverse();
  const bool struts = has_plain_struts(machine);
  in_shares(status.size(), kShare, threads, [&](std::size_t begin, std::size_t end) {
    Block block;
    for (std::size_t at = begin; at < end; at += kBlock) {
      const std::size_t size = std::min(kBlock, end - at);
      double* const answers = &axes[count * at];
      read_block(poses.subspan(kPoseNumbers * at), X_BW, size, block);
      if (struts)
        solve_struts(machine.hexapod(), block, size, answers, &status[at]);
      else
        solve_axes_one_by_one(*mechanism, block, size, answers, &status[at]);
      put_status(block, size, count, answers, &status[at]);
    }
  });
}

void poses_of_axes(const MachineDescription& machine, std::span<const double> axes, std::span<double> poses,
                   StatusBytes status, int threads) {
  const auto count = static_cast<std::size_t>(machine.make_mechanism()->axis_count());
  check_sizes(poses.size(), axes.size(), status.size(), count);
  in_shares(status.size(), kForwardShare, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<AxisVector> rows(end - begin);
    for (std::size_t n = begin; n < end; ++n) std::copy_n(&axes[count * n], count, rows[n - begin].begin());
    const std::vector<SolvedPose> solved = solve_poses(machine, rows);
    for (std::size_t n = begin; n < end; ++n) {
      const SolvedPose& one = solved[n - begin];
      status[n] = byte(one.status);
      if (one.status == SolveStatus::ok)
        write_pose(machine.X_WB * one.X_BT, &poses[kPoseNumbers * n]);
      else
        std::fill_n(&poses[kPoseNumbers * n], kPoseNumbers, kNone);
    }
  });
}

}  // namespace understudy::machine
