// Numbers as G-code has them.
#pragma once

#include <string>

namespace understudy::toolpath {

/// Fixed point without trailing zeros; never an exponent, which G-code would read as an E word.
std::string plain_number(double value, int decimals);

}  // namespace understudy::toolpath
