// Poses into lanes and back, between hexapod_batch.cpp and the files that are compiled for one processor
// each. Plain numbers only, for the reason given in hexapod_lanes.h.
#pragma once

#include "kinematics/hexapod/hexapod_newton.h"
#include "kinematics/quaternion_rotation.h"

namespace understudy::kinematics::simd {

struct Answer {
  Platform<double> X;
  double residual, iterations;
  bool ok;
};

/// Poses are 4 x 4 matrices by columns, lengths six numbers each. Returns how many were done: a multiple of
/// the lanes, the rest is the caller's. `ok` false: not here, ask the single call.
using InverseMany = long (*)(const Hexapod&, const double* poses, double* lengths, bool* ok, long count);
using ForwardMany = long (*)(const Hexapod&, const double* lengths, const double* seeds,
                             const NewtonSettings&, Answer* answers, long count);

/// The same of rows of seven numbers (kinematics/pose_row.h); `unit`: how far from length 1 a quaternion may
/// be.
using InverseRows = long (*)(const Hexapod&, const double* rows, double unit, double* lengths, bool* ok,
                             long count);
long inverse_rows_avx2(const Hexapod&, const double* rows, double unit, double* lengths, bool* ok,
                       long count);

long inverse_many_avx2(const Hexapod&, const double* poses, double* lengths, bool* ok, long count);
long forward_many_avx2(const Hexapod&, const double* lengths, const double* seeds, const NewtonSettings&,
                       Answer* answers, long count);

template <class Lane>
constexpr int kLanes = sizeof(Lane) / sizeof(double);

template <class Lane>
void gather(const double* poses, Platform<Lane>& X) {
  for (int l = 0; l < kLanes<Lane>; ++l) {
    const double* pose = poses + 16 * static_cast<long>(l);
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) X.R[k][j][l] = pose[4 * j + k];
      X.p[k][l] = pose[12 + k];
    }
  }
}

/// Lanes of one after the other; false where a row is no pose.
template <class Lane>
Mask<Lane> gather_rows(const double* rows, double unit, Platform<Lane>& X) {
  Lane w{}, x{}, y{}, z{};
  for (int l = 0; l < kLanes<Lane>; ++l) {
    const double* row = rows + 7 * static_cast<long>(l);
    for (int k = 0; k < 3; ++k) X.p[k][l] = row[k];
    w[l] = row[3];
    x[l] = row[4];
    y[l] = row[5];
    z[l] = row[6];
  }
  return rotation(w, x, y, z, unit, X.R);
}

/// Lengths of lanes `done` and on, where `good` and the struts allow it; which, in `ok`.
template <class Lane>
void put_lengths(const Hexapod& g, const Platform<Lane>& X, Mask<Lane> good, double* lengths, bool* ok) {
  Struts<Lane> struts;
  find_struts(g, X, struts);
  for (int i = 0; i < kStrutCount; ++i)
    good = good & (struts.squared[i] > 0.0) & (struts.squared[i] < __builtin_inf());
  for (int i = 0; i < kStrutCount; ++i) {
    const Lane length = root(struts.squared[i]);
    for (int l = 0; l < kLanes<Lane>; ++l)
      if (good[l]) lengths[kStrutCount * l + i] = length[l];
  }
  for (int l = 0; l < kLanes<Lane>; ++l) ok[l] = good[l] != 0;
}

template <class Lane>
long inverse_many(const Hexapod& g, const double* poses, double* lengths, bool* ok, long count) {
  constexpr int kCount = kLanes<Lane>;
  long done = 0;
  for (; done + kCount <= count; done += kCount) {
    Platform<Lane> X;
    gather(poses + 16 * done, X);
    put_lengths(g, X, X.p[0] == X.p[0], lengths + kStrutCount * done, ok + done);
  }
  return done;
}

template <class Lane>
long inverse_rows(const Hexapod& g, const double* rows, double unit, double* lengths, bool* ok, long count) {
  constexpr int kCount = kLanes<Lane>;
  long done = 0;
  for (; done + kCount <= count; done += kCount) {
    Platform<Lane> X{};
    const Mask<Lane> poses = gather_rows(rows + 7 * done, unit, X);
    put_lengths(g, X, poses, lengths + kStrutCount * done, ok + done);
  }
  return done;
}

template <class Lane>
long forward_many(const Hexapod& g, const double* lengths, const double* seeds,
                  const NewtonSettings& settings, Answer* answers, long count) {
  constexpr int kCount = kLanes<Lane>;
  long done = 0;
  for (; done + kCount <= count; done += kCount) {
    Platform<Lane> seed;
    Lane target[kStrutCount];
    gather(seeds + 16 * done, seed);
    for (int l = 0; l < kCount; ++l)
      for (int i = 0; i < kStrutCount; ++i) target[i][l] = lengths[kStrutCount * (done + l) + i];
    const NewtonResult<Lane> result = newton(g, target, seed, settings);
    for (int l = 0; l < kCount; ++l) {
      Answer& answer = answers[done + l];
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) answer.X.R[k][j] = result.X.R[k][j][l];
        answer.X.p[k] = result.X.p[k][l];
      }
      answer.residual = result.residual[l];
      answer.iterations = result.iterations[l];
      answer.ok = result.ok[l] != 0;
    }
  }
  return done;
}

}  // namespace understudy::kinematics::simd
