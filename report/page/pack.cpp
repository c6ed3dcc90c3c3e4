#include "report/page/pack.h"

#include <zlib.h>

#include <cmath>

#include "core/error.h"
#include "report/picture/png.h"

namespace understudy::report {

std::string pack_text(std::string_view text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                static_cast<uLong>(text.size()), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK)
    throw MachineError("zlib cannot pack the page's data: status " + std::to_string(status));
  packed.resize(size);
  return base64(packed);
}

std::string pack_integers(const std::vector<std::int64_t>& values) {
  std::string bytes;
  std::int64_t last = 0;
  for (const std::int64_t value : values) {
    const std::int64_t step = value - last;
    last = value;
    auto rest = (static_cast<std::uint64_t>(step) << 1) ^ static_cast<std::uint64_t>(step >> 63);
    while (rest >= 0x80) {
      bytes += static_cast<char>(0x80 | (rest & 0x7f));
      rest >>= 7;
    }
    bytes += static_cast<char>(rest);
  }
  return pack_text(bytes);
}

std::string pack_values(const std::vector<double>& values, double unit) {
  std::vector<std::int64_t> whole;
  whole.reserve(values.size());
  for (const double value : values) {
    const double n = std::round(value / unit);
    whole.push_back(std::abs(n) < static_cast<double>(kNone) ? static_cast<std::int64_t>(n) : kNone);
  }
  return pack_integers(whole);
}

std::string loaded_zlib() { return zlibVersion(); }

}  // namespace understudy::report
