#include "kinematics/chain/angles.h"

#include <cmath>
#include <limits>
#include <numbers>

// Without contraction of products, wider vectors give the same bytes. The sanitizers run before the dynamic
// linker has chosen a clone.
#if defined(__x86_64__) && !defined(UNDERSTUDY_SANITIZED)
#define UNDERSTUDY_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define UNDERSTUDY_VECTOR_CLONES
#endif

namespace understudy::kinematics {
namespace {

// atan(t) = t + t^3 P(t^2)/Q(t^2) for |t| <= 0.66 (Moshier, Cephes library, atan).
inline double small_arc(double t) {
  const double z = t * t;
  const double p =
      (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
       1.228866684490136173410e2) *
          z -
      6.485021904942025371773e1;
  const double q =
      ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) *
           z +
       4.853903996359136964868e2) *
          z +
      1.945506571482613964425e2;
  return t + t * (z * p / q);
}

inline double angle_of(double sine, double cosine) {
  constexpr double kPi = std::numbers::pi;
  const double s = std::abs(sine), c = std::abs(cosine);
  const bool steep = s > c;
  const double low = steep ? c : s;
  const double high = (steep ? s : c) + std::numeric_limits<double>::min();
  const bool wide = low > 0.66 * high;
  const double arc = small_arc((wide ? low - high : low) / (wide ? low + high : high));
  const double first = arc + (wide ? kPi / 4 : 0.0);
  const double octants = steep ? kPi / 2 - first : first;
  return std::copysign(cosine < 0 ? kPi - octants : octants, sine);
}

}  // namespace

UNDERSTUDY_VECTOR_CLONES
void angles_of(const double* __restrict sine, const double* __restrict cosine, double* __restrict angle,
               int count) {
  for (int i = 0; i < count; ++i) angle[i] = angle_of(sine[i], cosine[i]);
}

}  // namespace understudy::kinematics
