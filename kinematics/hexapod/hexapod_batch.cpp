#include "kinematics/hexapod/hexapod_batch.h"

#include <algorithm>
#include <array>
#include <thread>
#include <vector>

#include "core/simd.h"
#include "kinematics/hexapod/hexapod_batch_simd.h"
#include "kinematics/hexapod/hexapod_numbers.h"
#include "kinematics/pose_row.h"

namespace understudy::kinematics {
namespace {

static_assert(sizeof(Pose) == 16 * sizeof(double) && sizeof(StrutLengths) == kStruts * sizeof(double));

constexpr long kBlock = 64;  // answers kept at a time
// Poses; fewer take less time than some starts of a thread.
constexpr long kInverseWorthAThread = 8192;
constexpr long kForwardWorthAThread = 1024;

using TwoLanes [[gnu::vector_size(16)]] = double;

/// None: every answer is the single call's.
simd::InverseMany inverse_many() {
  const Simd instructions = understudy::simd();
#ifdef UNDERSTUDY_AVX2
  if (instructions == Simd::avx2) return simd::inverse_many_avx2;
#endif
  return instructions == Simd::scalar ? nullptr : simd::inverse_many<TwoLanes>;
}

simd::InverseRows inverse_rows_many() {
  const Simd instructions = understudy::simd();
#ifdef UNDERSTUDY_AVX2
  if (instructions == Simd::avx2) return simd::inverse_rows_avx2;
#endif
  return instructions == Simd::scalar ? nullptr : simd::inverse_rows<TwoLanes>;
}

SolveStatus inverse_of_row(const HexapodGeometry& geometry, const double* row, StrutLengths& lengths) {
  Pose X;
  return read_pose(row, X) ? inverse(geometry, X, lengths) : SolveStatus::bad_input;
}

simd::ForwardMany forward_many() {
  const Simd instructions = understudy::simd();
#ifdef UNDERSTUDY_AVX2
  if (instructions == Simd::avx2) return simd::forward_many_avx2;
#endif
  return instructions == Simd::scalar ? nullptr : simd::forward_many<TwoLanes>;
}

/// work(begin, end) for parts of [0, count), on as many threads as are worth it.
template <typename Work>
void in_parts(long count, long worth_a_thread, int threads, const Work& work) {
  const long wanted = threads > 0 ? threads : static_cast<long>(std::thread::hardware_concurrency());
  const long parts = std::clamp(wanted, 1L, std::max(1L, count / worth_a_thread));
  std::vector<std::thread> others;
  for (long n = 1; n < parts; ++n)
    others.emplace_back([&, n] { work(count * n / parts, count * (n + 1) / parts); });
  work(0L, count / parts);
  for (std::thread& other : others) other.join();
}

}  // namespace

void inverse_batch(const HexapodGeometry& geometry, std::span<const Pose> X_BT,
                   std::span<StrutLengths> lengths, std::span<SolveStatus> status, int threads) {
  const auto count = static_cast<long>(std::min({X_BT.size(), lengths.size(), status.size()}));
  const simd::Hexapod g = plain_numbers(geometry);
  const simd::InverseMany many = inverse_many();
  in_parts(count, kInverseWorthAThread, threads, [&](long begin, long end) {
    std::array<bool, kBlock> ok;
    for (long at = begin; at < end; at += kBlock) {
      const long size = std::min(kBlock, end - at);
      const long done = many ? many(g, X_BT[at].data(), lengths[at].data(), ok.data(), size) : 0;
      for (long n = 0; n < size; ++n) {
        const bool have = n < done && ok[n];
        status[at + n] = have ? SolveStatus::ok : inverse(geometry, X_BT[at + n], lengths[at + n]);
      }
    }
  });
}

void inverse_rows(const HexapodGeometry& geometry, std::span<const double> rows,
                  std::span<StrutLengths> lengths, std::span<SolveStatus> status) {
  const auto count = static_cast<long>(std::min({rows.size() / kPoseNumbers, lengths.size(), status.size()}));
  const simd::Hexapod g = plain_numbers(geometry);
  const simd::InverseRows many = inverse_rows_many();
  std::array<bool, kBlock> ok;
  for (long at = 0; at < count; at += kBlock) {
    const long size = std::min(kBlock, count - at);
    const double* const first = &rows[kPoseNumbers * static_cast<std::size_t>(at)];
    const long done = many ? many(g, first, kUnitQuaternion, lengths[at].data(), ok.data(), size) : 0;
    for (long n = 0; n < size; ++n) {
      const bool have = n < done && ok[n];
      status[at + n] =
          have ? SolveStatus::ok : inverse_of_row(geometry, first + kPoseNumbers * n, lengths[at + n]);
    }
  }
}

void forward_batch(const HexapodGeometry& geometry, std::span<const StrutLengths> lengths,
                   std::span<const Pose> seeds, std::span<ForwardResult> results,
                   const ForwardOptions& options, int threads) {
  const auto count = static_cast<long>(std::min({lengths.size(), seeds.size(), results.size()}));
  const simd::Hexapod g = plain_numbers(geometry);
  const simd::ForwardMany many = forward_many();
  const simd::NewtonSettings settings = newton_settings(options);
  in_parts(count, kForwardWorthAThread, threads, [&](long begin, long end) {
    std::array<simd::Answer, kBlock> answers;
    for (long at = begin; at < end; at += kBlock) {
      const long size = std::min(kBlock, end - at);
      const long done =
          many ? many(g, lengths[at].data(), seeds[at].data(), settings, answers.data(), size) : 0;
      for (long n = 0; n < size; ++n) {
        const long k = at + n;
        const simd::Answer& a = answers[n];
        results[k] = n < done && a.ok ? ForwardResult{SolveStatus::ok, pose_of(a.X),
                                                      static_cast<int>(a.iterations), a.residual}
                                      : forward(geometry, lengths[k], seeds[k], options);
      }
    }
  });
}

}  // namespace understudy::kinematics
