#include "report/page/unpack.h"

#include <zlib.h>

#include <array>
#include <limits>

#include "core/error.h"
#include "core/file/read_file.h"
#include "report/page/pack.h"

namespace understudy::report {
namespace {

std::array<int, 256> make_digits() {
  std::array<int, 256> digits{};
  digits.fill(-1);
  int value = 0;
  for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"))
    digits[static_cast<unsigned char>(c)] = value++;
  return digits;
}

std::string from_base64(std::string_view text) {
  static const std::array<int, 256> digits = make_digits();
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  unsigned held = 0, bits = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const int digit = digits[static_cast<unsigned char>(c)];
    if (digit < 0) throw InputError("a packed column is no base64");
    held = (held << 6 | static_cast<unsigned>(digit)) & 0xffff;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xff);
  }
  return bytes;
}

/// A stream of zlib's that is read to its end.
class Inflation {
 public:
  Inflation() {
    if (inflateInit(&stream_) != Z_OK) throw MachineError("zlib cannot unpack the page's data");
  }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  std::string all_of(std::string& bytes) {
    stream_.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_in = static_cast<uInt>(bytes.size());
    std::string text;
    std::array<char, 1 << 16> piece{};
    int status = Z_OK;
    while (status == Z_OK) {
      stream_.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream_.avail_out = static_cast<uInt>(piece.size());
      status = inflate(&stream_, Z_NO_FLUSH);
      text.append(piece.data(), piece.size() - stream_.avail_out);
      if (text.size() > kFileMax) throw InputError("a packed column is longer than 10^9 bytes");
    }
    if (status != Z_STREAM_END) throw InputError("a packed column is damaged or cut short");
    return text;
  }

 private:
  z_stream stream_{};
};

}  // namespace

std::vector<std::int64_t> unpack_integers(std::string_view packed) {
  std::string bytes = from_base64(packed);
  std::vector<std::int64_t> values;
  std::uint64_t rest = 0, last = 0;
  int shift = 0;
  for (const char c : Inflation().all_of(bytes)) {
    if (shift > 63) throw InputError("a packed column holds a number of more than 64 bits");
    rest |= static_cast<std::uint64_t>(c & 0x7f) << shift;
    shift += 7;
    if (c & 0x80) continue;
    last += (rest >> 1) ^ (~(rest & 1) + 1);
    values.push_back(static_cast<std::int64_t>(last));
    rest = 0;
    shift = 0;
  }
  return values;
}

std::vector<double> unpack_values(std::string_view packed, double unit) {
  std::vector<double> values;
  for (const std::int64_t n : unpack_integers(packed))
    values.push_back(n == kNone ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(n) * unit);
  return values;
}

}  // namespace understudy::report
