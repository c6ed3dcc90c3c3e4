// Newton's steps of the hexapod's forward kinematics while all goes well: every step whole, with a smaller
// residual, and on its side of the singularities. Lanes where it does not are left to forward(), which
// shortens steps and says what is in the way.
#pragma once

#include "kinematics/hexapod/hexapod_simd.h"

namespace understudy::kinematics::simd {

struct NewtonSettings {
  double tolerance;   ///< [m], largest length residual
  int iterations;     ///< at most
  double travel_max;  ///< of one step, per mean strut length
  double turn_max;    ///< [rad], of one step
  double skew_max;    ///< of R^T R - 1 in a seed
  double det_min;     ///< of J and of its first block, with moments over the platform's radius
};

template <class Number>
struct NewtonResult {
  Platform<Number> X;
  Number residual;    ///< [m], largest
  Number iterations;  ///< steps taken
  Mask<Number> ok;
};

/// One step of R (3 - R^T R) / 2 towards the nearest rotation: squares what R lacks of being one. Returns the
/// largest entry of R^T R - 1.
template <class Number>
Number straighten(Platform<Number>& X) {
  Number E[3][3], worst{};
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      E[i][j] = X.R[0][i] * X.R[0][j] + X.R[1][i] * X.R[1][j] + X.R[2][i] * X.R[2][j] - (i == j ? 1.0 : 0.0);
      E[j][i] = E[i][j];
      worst = larger(magnitude(E[i][j]), worst);
    }
  }
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    Number row[3];
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j)
      row[j] = X.R[k][j] - 0.5 * (X.R[k][0] * E[0][j] + X.R[k][1] * E[1][j] + X.R[k][2] * E[2][j]);
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) X.R[k][j] = row[j];
  }
  return worst;
}

template <class Number>
Number handedness(const Number (&R)[3][3]) {
  return R[0][0] * (R[1][1] * R[2][2] - R[1][2] * R[2][1]) +
         R[0][1] * (R[1][2] * R[2][0] - R[1][0] * R[2][2]) +
         R[0][2] * (R[1][0] * R[2][1] - R[1][1] * R[2][0]);
}

/// R turned by the rotation whose half-angle tangent vector is w / 2 (Cayley): exp(w) to second order, and a
/// rotation to rounding without a sine.
template <class Number>
void turn(Number (&R)[3][3], const Number (&w)[3]) {
  const Number h[3] = {0.5 * w[0], 0.5 * w[1], 0.5 * w[2]};
  const Number s = 2.0 / (1.0 + h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
#pragma GCC unroll 3
  for (int j = 0; j < 3; ++j) {
    const Number t[3] = {h[1] * R[2][j] - h[2] * R[1][j], h[2] * R[0][j] - h[0] * R[2][j],
                         h[0] * R[1][j] - h[1] * R[0][j]};
    R[0][j] = R[0][j] + s * (t[0] + (h[1] * t[2] - h[2] * t[1]));
    R[1][j] = R[1][j] + s * (t[1] + (h[2] * t[0] - h[0] * t[2]));
    R[2][j] = R[2][j] + s * (t[2] + (h[0] * t[1] - h[1] * t[0]));
  }
}

// Rows of J, moments over the radius, are below 2 long where the joints lie within two radii, and a step
// changes them by less than 10 times its size (travel over length plus turn). By Hadamard a determinant of
// six such rows moves by less than 6 * 2^5 * 10 steps, so one this much shorter leaves its sign.
constexpr double kShortStep = 1e-4;

template <class Number>
NewtonResult<Number> newton(const Hexapod& g, const Number (&target)[kStrutCount],
                            const Platform<Number>& seed, const NewtonSettings& settings) {
  NewtonResult<Number> result{};
  Platform<Number>& X = result.X;
  X = seed;
  Number norm_before{}, det_before{}, step{}, mean{};
  for (int i = 0; i < kStrutCount; ++i) mean = mean + target[i] * (1.0 / kStrutCount);
  const Number travel_max = settings.travel_max * mean;
  const Mask<Number> orthogonal = straighten(X) < settings.skew_max;
  const Mask<Number> right_handed = handedness(X.R) > 0.0;
  Mask<Number> running = orthogonal & right_handed;
  for (int n = 0;; ++n) {
    Struts<Number> struts;
    Number length[kStrutCount], residual[kStrutCount], norm{}, worst{};
    find_struts(g, X, struts);
    find_residuals(struts, target, length, residual);
#pragma GCC unroll 6
    for (int i = 0; i < kStrutCount; ++i) {
      norm = norm + residual[i] * residual[i];
      worst = larger(magnitude(residual[i]), worst);
    }
    running = running & (n == 0 ? norm == norm : norm < norm_before);
    norm_before = norm;
    result.residual = running ? worst : result.residual;
    const Mask<Number> settled = running & (worst <= settings.tolerance);
    const Mask<Number> short_step = step < kShortStep * magnitude(det_before);
    if (n > 0) {
      result.ok = result.ok | (settled & short_step);
      running = running & !result.ok;
    }
    if (!any(running)) break;

    Linear<Number> at;
    Factors<Number> factors;
    linearise(struts, length, at);
    factorise(at, factors);
    const Number det = factors.det_A * factors.det_S * g.per_radius_cubed;
    const Mask<Number> A_regular = magnitude(factors.det_A) > settings.det_min;
    const Mask<Number> J_regular = magnitude(det) > settings.det_min;
    running = running & A_regular & J_regular;
    if (n > 0) running = running & (det * det_before > 0.0);
    det_before = det;
    result.ok = result.ok | (running & settled);
    running = running & !settled;
    if (n == settings.iterations || !any(running)) break;

    Number travel[3], w[3];
    solve(factors, residual, travel, w);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) w[k] = -w[k];
    const Number travel2 = times(travel, travel), turn2 = times(w, w);
    running =
        running & (travel2 <= travel_max * travel_max) & (turn2 <= settings.turn_max * settings.turn_max);
    if (!any(running)) break;
    step = root(travel2) / travel_max + root(turn2);
    Platform<Number> next = X;
    turn(next.R, w);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      X.p[k] = running ? X.p[k] - travel[k] : X.p[k];
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) X.R[k][j] = running ? next.R[k][j] : X.R[k][j];
    }
    result.iterations = running ? result.iterations + 1.0 : result.iterations;
  }
  straighten(X);
  return result;
}

}  // namespace understudy::kinematics::simd
