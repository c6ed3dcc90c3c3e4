#include "kinematics/hexapod/hexapod_batch.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include "core/simd.h"
#include "kinematics/pose_row.h"
#include "tests/kinematics/workspace/workspace_pose.h"

namespace understudy::kinematics {
namespace {

struct Cases {
  std::vector<Pose> poses, seeds;
  std::vector<StrutLengths> lengths;
};

// Among the poses some without an answer, among the seeds some far off and some useless: not a whole number
// of lanes or blocks either.
Cases mixed_cases(const HexapodGeometry& g, std::size_t count) {
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  Random random(61, "batch");
  Cases cases;
  for (std::size_t n = 0; n < count; ++n) {
    Pose X = workspace_pose(g, joints, random, from_deg(20));
    StrutLengths lengths{};
    EXPECT_EQ(inverse(g, X, lengths), SolveStatus::ok);
    Pose seed = n % 17 == 3 ? nearby(X, 0.1, from_deg(40), random) : nearby(X, 1e-3, from_deg(1), random);
    if (n % 101 == 7) seed.translation().x() = std::numeric_limits<double>::infinity();
    if (n % 103 == 9) seed.linear().col(0) *= -1;
    if (n % 107 == 11) lengths[3] = 0.6;
    if (n % 109 == 5) X.translation() = g.base_joint[2] - X.linear() * g.platform_joint[2];
    if (n % 113 == 6) X.linear()(1, 1) = std::numeric_limits<double>::quiet_NaN();
    cases.poses.push_back(X);
    cases.seeds.push_back(seed);
    cases.lengths.push_back(lengths);
  }
  return cases;
}

/// Each choice of instructions, one after the other; those that the processor lacks left out.
template <typename Check>
void with_all_instructions(const Check& check) {
  ::unsetenv("UNDERSTUDY_SIMD");
  const Simd most = understudy::simd();
  for (const Simd choice : {Simd::scalar, Simd::sse2, Simd::avx2}) {
    if (choice > most) continue;
    ::setenv("UNDERSTUDY_SIMD", word(choice), 1);
    SCOPED_TRACE(word(choice));
    check();
  }
  ::unsetenv("UNDERSTUDY_SIMD");
}

bool same_bytes(const void* a, const void* b, std::size_t size) { return std::memcmp(a, b, size) == 0; }

// The single calls are the reference; 1e-15 relative is asked for, the bytes are what is kept.
void expect_inverse_of_single_calls() {
  for (const double deviation : {0.0, 0.015}) {
    const HexapodGeometry g = nominal_g4(deviation);
    const Cases cases = mixed_cases(g, 5003);
    for (const int threads : {1, 2, 3, 0}) {
      std::vector<StrutLengths> lengths(cases.poses.size(), StrutLengths{9, 9, 9, 9, 9, 9});
      std::vector<SolveStatus> status(cases.poses.size(), SolveStatus::not_converged);
      inverse_batch(g, cases.poses, lengths, status, threads);
      for (std::size_t n = 0; n < cases.poses.size(); ++n) {
        StrutLengths expected{9, 9, 9, 9, 9, 9};
        ASSERT_EQ(status[n], inverse(g, cases.poses[n], expected)) << n;
        ASSERT_TRUE(same_bytes(lengths[n].data(), expected.data(), sizeof expected)) << n;
      }
    }
  }
}

TEST(HexapodBatch, InverseIsThatOfSingleCallsToTheBit) {
  with_all_instructions(expect_inverse_of_single_calls);
}

// Rows are the single calls of the poses that read_pose() makes of them, in every lane and at every place.
void expect_rows_of_single_calls() {
  for (const double deviation : {0.0, 0.015}) {
    const HexapodGeometry g = nominal_g4(deviation);
    const Cases cases = mixed_cases(g, 5003);
    std::vector<double> rows(kPoseNumbers * cases.poses.size());
    for (std::size_t n = 0; n < cases.poses.size(); ++n) {
      double* const row = &rows[kPoseNumbers * n];
      write_pose(cases.poses[n], row);
      if (n % 97 == 4) row[4] += 0.01;                          // of another length
      for (int k = 3; n % 89 == 2 && k < 7; ++k) row[k] *= -1;  // the same rotation
    }
    std::vector<StrutLengths> lengths(cases.poses.size(), StrutLengths{9, 9, 9, 9, 9, 9});
    std::vector<SolveStatus> status(cases.poses.size(), SolveStatus::not_converged);
    inverse_rows(g, rows, lengths, status);
    int refused = 0;
    for (std::size_t n = 0; n < cases.poses.size(); ++n) {
      StrutLengths expected{9, 9, 9, 9, 9, 9};
      Pose X;
      const bool is_pose = read_pose(&rows[kPoseNumbers * n], X);
      ASSERT_EQ(status[n], is_pose ? inverse(g, X, expected) : SolveStatus::bad_input) << n;
      ASSERT_TRUE(same_bytes(lengths[n].data(), expected.data(), sizeof expected)) << n;
      refused += !is_pose;
    }
    EXPECT_GT(refused, 50);
  }
}

TEST(HexapodBatch, RowsAreSingleCallsToTheBit) { with_all_instructions(expect_rows_of_single_calls); }

void expect_forward_of_single_calls() {
  for (const double deviation : {0.0, 0.015}) {
    const HexapodGeometry g = nominal_g4(deviation);
    const Cases cases = mixed_cases(g, 3001);
    for (const int threads : {1, 2, 0}) {
      std::vector<ForwardResult> results(cases.poses.size());
      forward_batch(g, cases.lengths, cases.seeds, results, {}, threads);
      for (std::size_t n = 0; n < results.size(); ++n) {
        const ForwardResult expected = forward(g, cases.lengths[n], cases.seeds[n]);
        ASSERT_EQ(results[n].status, expected.status) << n;
        ASSERT_EQ(results[n].iterations, expected.iterations) << n;
        ASSERT_EQ(results[n].residual, expected.residual) << n;
        ASSERT_TRUE(same_bytes(results[n].X_BT.data(), expected.X_BT.data(), 16 * sizeof(double))) << n;
      }
    }
  }
}

TEST(HexapodBatch, ForwardIsThatOfSingleCallsToTheBit) {
  with_all_instructions(expect_forward_of_single_calls);
}

TEST(HexapodBatch, ShortAndEmptySpansAreTaken) {
  const HexapodGeometry g = nominal_g4();
  inverse_batch(g, {}, {}, {});
  const std::vector<Pose> poses(3, Pose::Identity());
  std::vector<StrutLengths> lengths(2);
  std::vector<SolveStatus> status(3, SolveStatus::not_converged);
  inverse_batch(g, poses, lengths, status);
  EXPECT_EQ(status[1], SolveStatus::ok);
  EXPECT_EQ(status[2], SolveStatus::not_converged);
}

}  // namespace
}  // namespace understudy::kinematics
