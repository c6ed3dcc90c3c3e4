// Columns of numbers as text, small enough for a page.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::report {

/// What stands for a value that is missing.
inline constexpr std::int64_t kNone = std::int64_t{1} << 40;

/// Deflated (zlib, RFC 1950) and in base64.
std::string pack_text(std::string_view text);

/// The differences of neighbours, each as a variable-length integer of seven bits a byte, low bits first,
/// after (n << 1) ^ (n >> 63); then as pack_text().
std::string pack_integers(const std::vector<std::int64_t>& values);

/// Values in whole `unit`s; what is not finite is kNone.
std::string pack_values(const std::vector<double>& values, double unit);

/// Of zlib, as it is loaded: "1.2.13".
std::string loaded_zlib();

}  // namespace understudy::report
