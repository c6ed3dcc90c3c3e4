// Angles of many sines and cosines at once.
#pragma once

namespace understudy::kinematics {

/// atan2(sine, cosine) of `count` pairs, within 4 units in the last place; a pair need not be of length 1.
/// (0, 0) gives 0. Vectorised by the compiler; the bytes are those of one pair at a time.
void angles_of(const double* sine, const double* cosine, double* angle, int count);

}  // namespace understudy::kinematics
