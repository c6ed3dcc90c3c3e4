#include <cstddef>
#include <string>

#include "core/text/printable.h"
#include "tests/property.h"

namespace understudy {
namespace {

/// Code points by RFC 3629, decoded and compared with what the shortest form of each can be; -1: none.
int code_point(const std::string& text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  if (first < 0x80) return ++at, static_cast<int>(first);
  const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  if (first < 0xc0 || first > 0xf7) return -1;
  unsigned value = first & (0x3fu >> more);
  for (std::size_t i = 1; i <= more; ++i) {
    if ((byte(at + i) & 0xc0) != 0x80) return -1;
    value = value << 6 | (byte(at + i) & 0x3f);
  }
  constexpr unsigned kShortest[] = {0, 0x80, 0x800, 0x10000};
  if (value < kShortest[more] || value > 0x10ffff || (value >= 0xd800 && value < 0xe000)) return -1;
  at += more + 1;
  return static_cast<int>(value);
}

/// Bytes of every kind, those that begin and continue characters more often than by chance.
std::string drawn_text() {
  std::string text;
  for (int n = *rc::gen::inRange(0, 60); n > 0; --n) {
    const int kind = *property::whole(0, 3);
    const int byte = kind == 0   ? *property::whole(0, 255)
                     : kind == 1 ? *property::whole(0x80, 0xbf)
                     : kind == 2 ? *property::whole(0xc0, 0xff)
                                 : *property::whole(0x20, 0x7e);
    text += static_cast<char>(byte);
  }
  return text;
}

TEST(PrintableProperties, WhateverTheBytesTheTextIsValidAndMovesNoCursor) {
  property::check({3000, 100}, [] {
    const std::string text = drawn_text();
    const std::size_t limit = static_cast<std::size_t>(*property::whole(0, 200));
    const std::string out = printable(text, limit);
    RC_LOG() << "answer: " << rc::toString(out) << "\n";
    RC_ASSERT(out.size() <= limit + 5);
    for (std::size_t at = 0; at < out.size();) {
      const int point = code_point(out, at);
      RC_ASSERT(point >= 0x20);
      RC_ASSERT((point < 0x7f || point > 0x9f));
    }
  });
}

TEST(PrintableProperties, TextThatIsPrintableStaysAsItIs) {
  property::check({1000, 100}, [] {
    const std::string once = printable(drawn_text());
    RC_ASSERT(printable(once) == once);
  });
}

}  // namespace
}  // namespace understudy
