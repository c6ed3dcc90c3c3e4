// Numbers of result files: equal to so many digits, so that their bytes do not hang on the last bit.
#pragma once

namespace understudy {

/// Rounded to `digits` significant digits; no negative zero. Throws std::logic_error naming `what` when the
/// value is not finite.
double stable_number(double value, const char* what, int digits = 6);

}  // namespace understudy
