// Packed columns as numbers again, by what docs/report-data.md says of them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace understudy::report {

inline std::string from_base64(const std::string& text) {
  std::string bytes;
  unsigned held = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const unsigned digit = static_cast<unsigned>(
        std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c));
    held = (held << 6) | digit;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>((held >> bits) & 0xff);
  }
  return bytes;
}

inline std::string unpacked(const std::string& packed) {
  const std::string bytes = from_base64(packed);
  std::string text(1 << 20, '\0');
  uLongf size = text.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(text.data()), &size,
                       reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  text.resize(size);
  return text;
}

/// As the header of the unit states it.
inline std::vector<std::int64_t> integers(const std::string& packed) {
  std::vector<std::int64_t> values;
  std::uint64_t rest = 0;
  int shift = 0;
  std::int64_t last = 0;
  for (const char c : unpacked(packed)) {
    rest |= static_cast<std::uint64_t>(c & 0x7f) << shift;
    shift += 7;
    if (c & 0x80) continue;
    last += static_cast<std::int64_t>(rest >> 1) ^ -static_cast<std::int64_t>(rest & 1);
    values.push_back(last);
    rest = 0;
    shift = 0;
  }
  return values;
}

}  // namespace understudy::report
