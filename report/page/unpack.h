// What pack.h packed, as numbers again.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::report {

/// Of pack_integers(). InputError where the text is no such column, or one of more than 10^9 bytes.
std::vector<std::int64_t> unpack_integers(std::string_view packed);

/// Of pack_values(), times `unit`; a missing value is NaN.
std::vector<double> unpack_values(std::string_view packed, double unit);

}  // namespace understudy::report
