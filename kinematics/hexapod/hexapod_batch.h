// The hexapod's kinematics for arrays of poses: several poses in the lanes of one instruction (core/simd.h),
// and ranges of them on all cores. Every result is that of the single call, to the bit,
// whatever the processor and the number of threads. Not for control cycles: threads are started and joined.
#pragma once

#include <span>

#include "kinematics/hexapod/hexapod.h"

namespace understudy::kinematics {

/// As many as the shortest span holds; `threads` 0: one for each core. Lengths of a pose without an answer
/// stay as they were.
void inverse_batch(const HexapodGeometry& geometry, std::span<const Pose> X_BT,
                   std::span<StrutLengths> lengths, std::span<SolveStatus> status, int threads = 0);

/// Of poses as rows of seven numbers (kinematics/pose_row.h), on the calling thread; a row that is no pose is
/// `bad_input`.
void inverse_rows(const HexapodGeometry& geometry, std::span<const double> rows,
                  std::span<StrutLengths> lengths, std::span<SolveStatus> status);

/// Each from its own seed, by the branch rule of forward().
void forward_batch(const HexapodGeometry& geometry, std::span<const StrutLengths> lengths,
                   std::span<const Pose> seeds, std::span<ForwardResult> results,
                   const ForwardOptions& options = {}, int threads = 0);

}  // namespace understudy::kinematics
