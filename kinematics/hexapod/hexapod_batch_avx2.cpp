// Compiled with -mavx2 and called only where the processor has it.
#include "kinematics/hexapod/hexapod_batch_simd.h"

namespace understudy::kinematics::simd {

using FourLanes [[gnu::vector_size(32)]] = double;

long inverse_many_avx2(const Hexapod& g, const double* poses, double* lengths, bool* ok, long count) {
  return inverse_many<FourLanes>(g, poses, lengths, ok, count);
}

long inverse_rows_avx2(const Hexapod& g, const double* rows, double unit, double* lengths, bool* ok,
                       long count) {
  return inverse_rows<FourLanes>(g, rows, unit, lengths, ok, count);
}

long forward_many_avx2(const Hexapod& g, const double* lengths, const double* seeds,
                       const NewtonSettings& settings, Answer* answers, long count) {
  return forward_many<FourLanes>(g, lengths, seeds, settings, answers, count);
}

}  // namespace understudy::kinematics::simd
