#include "geometry/stl_structure.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::geometry {
namespace {

constexpr std::size_t kHeader = 84;    // title of 80 bytes, then the number of triangles
constexpr std::size_t kTriangle = 50;  // normal, three corners, attribute

std::uint32_t announced_triangles(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);  // little-endian, as the format and our machines are
  return count;
}

// Words of the file one by one, with the line that each is on.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  int line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

bool same_word(std::string_view word, std::string_view expected) {
  if (word.size() != expected.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c) != expected[i]) return false;
  }
  return true;
}

class TextCheck {
 public:
  TextCheck(const std::string& bytes, const std::string& file) : words_(bytes), file_(file) {}

  void run() {
    std::string_view word = words_.next();
    while (same_word(word, "solid")) {
      words_.skip_line();
      word = words_.next();
      for (; same_word(word, "facet"); word = words_.next()) facet();
      if (!same_word(word, "endsolid")) fail(word, "facet or endsolid");
      words_.skip_line();
      word = words_.next();
    }
    if (!word.empty()) fail(word, "solid or the end of the file");
  }

 private:
  void facet() {
    expect("normal");
    numbers();
    expect("outer");
    expect("loop");
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      numbers();
    }
    expect("endloop");
    expect("endfacet");
  }
  void expect(const char* keyword) {
    const std::string_view word = words_.next();
    if (!same_word(word, keyword)) fail(word, keyword);
  }
  void numbers() {
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_.next();
      const std::size_t sign = !word.empty() && word[0] == '+';
      double value = 0;
      const auto [end, error] = std::from_chars(word.data() + sign, word.data() + word.size(), value);
      const bool whole = end == word.data() + word.size() && !word.empty();
      if (error == std::errc::invalid_argument || !whole) fail(word, "a number");
      if (error == std::errc::result_out_of_range || !std::isfinite(value))
        throw InputError({file_, words_.line(), 0}, fmt::format("'{}' is not a finite number", word));
    }
  }
  [[noreturn]] void fail(std::string_view word, const char* expected) {
    const Place place{file_, words_.line(), 0};
    if (word.empty())
      throw InputError(place, fmt::format("the file ends where {} should follow: it is truncated", expected));
    throw InputError(place, fmt::format("'{}' where {} should follow", word.substr(0, 40), expected));
  }

  Words words_;
  std::string file_;
};

bool starts_as_text(const std::string& bytes) {
  Words words(bytes);
  // Many binary titles begin with "solid" as well, but only a binary file holds zero bytes.
  return same_word(words.next(), "solid") && bytes.find('\0') == std::string::npos;
}

}  // namespace

void check_stl_structure(const std::string& bytes, const std::string& file) {
  if (bytes.empty()) throw InputError(Place{file}, "empty file, not an STL");
  const bool has_header = bytes.size() >= kHeader;
  if (has_header && bytes.size() == kHeader + kTriangle * announced_triangles(bytes)) return;
  if (starts_as_text(bytes)) return TextCheck(bytes, file).run();
  if (!has_header)
    throw InputError(Place{file},
                     fmt::format("{} bytes, shorter than the {} of an STL header", bytes.size(), kHeader));
  const std::uint32_t count = announced_triangles(bytes);
  const std::size_t expected = kHeader + kTriangle * count;
  throw InputError(Place{file},
                   fmt::format("{} bytes, {} than the {} of the {} triangles it announces: {}", bytes.size(),
                               bytes.size() < expected ? "shorter" : "longer", expected, count,
                               bytes.size() < expected ? "it is truncated" : "it is not a whole STL"));
}

}  // namespace understudy::geometry
