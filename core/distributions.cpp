#include "core/distributions.h"

#include <cmath>
#include <numbers>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

namespace understudy {

double chi_squared_exceeded(int degrees_of_freedom, double probability) {
  return quantile(complement(boost::math::chi_squared(degrees_of_freedom), probability));
}

double normal_quantile(double probability) { return quantile(boost::math::normal(), probability); }

double normal_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace understudy
