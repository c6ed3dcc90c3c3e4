// The arithmetic of the hexapod for one pose (Number = double) or for several side by side (Number = a vector
// of the compiler). One text for both, so a batch gives the bytes that single calls give. No Eigen here: this
// is also compiled for processors that not every machine has, and shared inline functions must not be.
#pragma once

namespace understudy::kinematics::simd {

constexpr int kStrutCount = 6;

struct Hexapod {
  double base[3][kStrutCount], ball[3][kStrutCount];  ///< [m], coordinates of b_i in B and a_i in T
  double deviation_squared;                           ///< [m^2]
  double per_radius_cubed;  ///< [1/m^3], of the platform: makes a determinant of moments comparable to 1
};

/// X_BT
template <class Number>
struct Platform {
  Number R[3][3], p[3];
};

template <class Number>
using Mask = decltype(Number{} < Number{});

inline double root(double x) { return __builtin_sqrt(x); }
template <class Number>
Number root(const Number& x) {
  Number result{};
  for (unsigned l = 0; l < sizeof(Number) / sizeof(double); ++l) result[l] = __builtin_sqrt(x[l]);
  return result;
}

inline bool any(bool mask) { return mask; }
template <class Vector>
bool any(const Vector& mask) {
  bool some = false;
  for (unsigned l = 0; l < sizeof(Vector) / sizeof(double); ++l) some |= mask[l] != 0;
  return some;
}

template <class Number>
Number magnitude(const Number& x) {
  return x < 0.0 ? -x : x;
}
template <class Number>
Number larger(const Number& a, const Number& b) {
  return a > b ? a : b;
}

template <class Number>
struct Struts {
  Number a[3][kStrutCount];     ///< R a_i, in B
  Number d[3][kStrutCount];     ///< from base to ball joint
  Number squared[kStrutCount];  ///< of the length (Song 2015, eqs 3-4)
};

template <class Number>
void find_struts(const Hexapod& g, const Platform<Number>& X, Struts<Number>& s) {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < kStrutCount; ++i) {
      s.a[k][i] = X.R[k][0] * g.ball[0][i] + X.R[k][1] * g.ball[1][i] + X.R[k][2] * g.ball[2][i];
      s.d[k][i] = (X.p[k] + s.a[k][i]) - g.base[k][i];
    }
  }
  for (int i = 0; i < kStrutCount; ++i)
    s.squared[i] =
        s.d[0][i] * s.d[0][i] + s.d[1][i] * s.d[1][i] + s.d[2][i] * s.d[2][i] - g.deviation_squared;
}

/// Lengths less their targets, NaN where there is no strut; `length` keeps the lengths.
template <class Number>
void find_residuals(const Struts<Number>& s, const Number (&target)[kStrutCount],
                    Number (&length)[kStrutCount], Number (&residual)[kStrutCount]) {
  for (int i = 0; i < kStrutCount; ++i) {
    length[i] = root(s.squared[i]);
    residual[i] = length[i] - target[i];
  }
}

/// Of the lengths by the pose: row i of J is (n, moment).
template <class Number>
struct Linear {
  Number n[3][kStrutCount], moment[3][kStrutCount];
};

template <class Number>
void linearise(const Struts<Number>& s, const Number (&length)[kStrutCount], Linear<Number>& at) {
  for (int i = 0; i < kStrutCount; ++i) {
    const Number per_length = 1.0 / length[i];
    for (int k = 0; k < 3; ++k) at.n[k][i] = s.d[k][i] * per_length;
  }
  for (int k = 0; k < 3; ++k) {
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    for (int i = 0; i < kStrutCount; ++i)
      at.moment[k][i] = s.a[k1][i] * at.n[k2][i] - s.a[k2][i] * at.n[k1][i];
  }
}

template <class Number>
using Block = Number[3][3];

/// Returns the determinant.
template <class Number>
Number cofactors(const Block<Number>& A, Block<Number>& cofactor) {
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor[i][j] = A[i1][j1] * A[i2][j2] - A[i1][j2] * A[i2][j1];
    }
  }
  return A[0][0] * cofactor[0][0] + A[0][1] * cofactor[0][1] + A[0][2] * cofactor[0][2];
}

template <class Number>
void inverse_of(const Block<Number>& cofactor, const Number& determinant, Block<Number>& inverse) {
  const Number reciprocal = 1.0 / determinant;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) inverse[i][j] = cofactor[j][i] * reciprocal;
  }
}

template <class Number>
Number times(const Number (&row)[3], const Number (&x)[3]) {
  return row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
}

/// J in blocks: A travel and B turn of struts 1, 3, 5; C and D of struts 2, 4, 6. No pivots, so nothing
/// depends on the order of rows; that costs digits where three struts are nearly coplanar, which determinants
/// tell: det J = det A det S with S = D - C A^-1 B.
template <class Number>
struct Factors {
  Block<Number> A_inverse, B, E, S_cofactor;  // E = C A^-1
  Number det_A, det_S;
};

template <class Number>
void factorise(const Linear<Number>& at, Factors<Number>& f) {
  Block<Number> A, S, cofactor;
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) {
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      A[r][k] = at.n[k][2 * r];
      f.B[r][k] = at.moment[k][2 * r];
    }
  }
  f.det_A = cofactors<Number>(A, cofactor);
  inverse_of<Number>(cofactor, f.det_A, f.A_inverse);
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) {
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k)
      f.E[r][k] = at.n[0][2 * r + 1] * f.A_inverse[0][k] + at.n[1][2 * r + 1] * f.A_inverse[1][k] +
                  at.n[2][2 * r + 1] * f.A_inverse[2][k];
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k)
      S[r][k] =
          at.moment[k][2 * r + 1] - (f.E[r][0] * f.B[0][k] + f.E[r][1] * f.B[1][k] + f.E[r][2] * f.B[2][k]);
  }
  f.det_S = cofactors<Number>(S, f.S_cofactor);
}

/// J (travel, turn) = residual
template <class Number>
void solve(const Factors<Number>& f, const Number (&residual)[kStrutCount], Number (&travel)[3],
           Number (&turn)[3]) {
  const Number first[3] = {residual[0], residual[2], residual[4]};
  const Number per_det = 1.0 / f.det_S;
  Number second[3], rest[3];
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) second[r] = residual[2 * r + 1] - times(f.E[r], first);
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r)
    turn[r] =
        (f.S_cofactor[0][r] * second[0] + f.S_cofactor[1][r] * second[1] + f.S_cofactor[2][r] * second[2]) *
        per_det;
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) rest[r] = first[r] - times(f.B[r], turn);
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) travel[r] = times(f.A_inverse[r], rest);
}

}  // namespace understudy::kinematics::simd
