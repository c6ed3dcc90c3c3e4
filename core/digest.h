// Fingerprints of inputs, for the record.
#pragma once

#include <string>
#include <string_view>

namespace understudy {

/// SHA-256 of the bytes, lower-case hexadecimal.
std::string sha256_hex(std::string_view bytes);

}  // namespace understudy
