#include "core/text/stable_number.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace understudy {

double stable_number(double value, const char* what, int digits) {
  if (!std::isfinite(value)) throw std::logic_error(std::string(what) + " is not a finite number");
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  const double rounded = std::strtod(text, nullptr);
  if (std::isinf(rounded)) return value;  // the few numbers that are so near to the largest one
  return rounded + 0.0;                   // adding 0 turns -0 into 0
}

}  // namespace understudy
