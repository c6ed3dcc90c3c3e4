// Poses into lanes and back, between hexapod_batch.cpp and the files that are compiled for one processor
// each. Plain numbers only, for the reason given in hexapod_lanes.h.
#pragma once

#include "kinematics/hexapod/hexapod_newton.h"

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

template <class Lane>
long inverse_many(const Hexapod& g, const double* poses, double* lengths, bool* ok, long count) {
  constexpr int kCount = kLanes<Lane>;
  long done = 0;
  for (; done + kCount <= count; done += kCount) {
    Platform<Lane> X;
    Struts<Lane> struts;
    gather(poses + 16 * done, X);
    find_struts(g, X, struts);
    Mask<Lane> good = struts.squared[0] > 0.0;
    for (int i = 0; i < kStrutCount; ++i)
      good = good & (struts.squared[i] > 0.0) & (struts.squared[i] < __builtin_inf());
    for (int i = 0; i < kStrutCount; ++i) {
      const Lane length = root(struts.squared[i]);
      for (int l = 0; l < kCount; ++l)
        if (good[l]) lengths[kStrutCount * (done + l) + i] = length[l];
    }
    for (int l = 0; l < kCount; ++l) ok[done + l] = good[l] != 0;
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
