#include "toolpath/gcode/words/gcode_lexer.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kShown = 40;  // characters of a line in a message

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

class LineLexer {
 public:
  LineLexer(std::string_view line, const std::string& file, int line_number)
      : line_(line), file_(file), line_number_(line_number) {}

  std::vector<Word> run() {
    std::vector<Word> words;
    for (skip_blanks(); at_ < line_.size(); skip_blanks()) {
      const char c = line_[at_];
      if (c == ';') break;
      if (c == '(')
        skip_comment();
      else if (is_letter(c))
        words.push_back(word());
      else if (c == '#' || c == '[')
        fail_language("variables and expressions");
      else
        fail(at_, fmt::format("{} starts no word", shown(c)));
    }
    return words;
  }

 private:
  void skip_blanks() {
    while (at_ < line_.size() && is_space(line_[at_])) ++at_;
  }
  /// Up to the parenthesis that belongs to the first; where none does, up to the next.
  void skip_comment() {
    std::size_t close = at_, depth = 0;
    for (; close < line_.size(); ++close) {
      if (line_[close] == '(') ++depth;
      if (line_[close] == ')' && --depth == 0) break;
    }
    if (close == line_.size()) close = line_.find(')', at_);
    if (close == std::string_view::npos) fail(at_, "the comment '(' is not closed on its line");
    at_ = close + 1;
  }

  Word word() {
    Word word;
    const std::size_t start = at_;
    if (upper(line_[at_]) == 'O') fail_language("O words (subroutines, loops, branches)");
    word.letter = upper(line_[at_++]);
    word.column = static_cast<int>(start) + 1;
    const bool apart = at_ >= line_.size() || is_space(line_[at_]) || line_[at_] == ';' || line_[at_] == '(';
    const std::size_t after_letter = at_;
    skip_blanks();
    word.bare = apart && !begins_number();
    word.quoted = at_ < line_.size() && line_[at_] == '"';
    if (word.quoted)
      skip_quoted();
    else if (word.bare)
      at_ = after_letter;
    else
      word.value = begins_expression() ? fail_language("variables and expressions") : number(start);
    word.text = line_.substr(start, at_ - start);
    return word;
  }

  bool begins_number() const {
    return at_ < line_.size() &&
           (is_digit(line_[at_]) || line_[at_] == '.' || line_[at_] == '-' || line_[at_] == '+');
  }
  bool begins_expression() const { return at_ < line_.size() && (line_[at_] == '#' || line_[at_] == '['); }

  void skip_quoted() {
    const std::size_t close = line_.find('"', at_ + 1);
    if (close == std::string_view::npos) fail(at_, "the text '\"' is not closed on its line");
    at_ = close + 1;
  }

  // Sign, digits, point, digits. E is a word of its own; a small e after a capital word's digits is an
  // exponent.
  double number(std::size_t word_start) {
    const std::size_t start = at_;
    if (at_ < line_.size() && (line_[at_] == '+' || line_[at_] == '-')) ++at_;
    std::size_t digits = 0, points = 0;
    for (; at_ < line_.size() && (is_digit(line_[at_]) || line_[at_] == '.'); ++at_)
      ++(line_[at_] == '.' ? points : digits);
    if (digits == 0 || points > 1) fail_number(word_start);
    const bool exponent = is_exponent(word_start);
    if (exponent) skip_exponent(word_start);
    const std::size_t first = line_[start] == '+' ? start + 1 : start;
    double value = 0;
    const auto [end, error] =
        std::from_chars(line_.data() + first, line_.data() + at_, value,
                        exponent ? std::chars_format::general : std::chars_format::fixed);
    // Without an exponent, digits before the point are the one way out of range upwards; downwards is zero.
    if (error == std::errc::result_out_of_range && (exponent || is_huge(line_.substr(first, at_ - first))))
      fail_number(word_start);
    if (end != line_.data() + at_ || !std::isfinite(value)) fail_number(word_start);
    return value;
  }

  void skip_exponent(std::size_t word_start) {
    ++at_;
    if (at_ < line_.size() && (line_[at_] == '+' || line_[at_] == '-')) ++at_;
    if (at_ >= line_.size() || !is_digit(line_[at_])) fail_number(word_start);
    while (at_ < line_.size() && is_digit(line_[at_])) ++at_;
  }

  /// X1e-06: a small e that follows the number of a capital word is no filament.
  bool is_exponent(std::size_t word_start) const {
    return at_ < line_.size() && line_[at_] == 'e' && line_[word_start] < 'a';
  }

  static bool is_huge(std::string_view digits) {
    const std::size_t first = digits.find_first_not_of("-0");
    return first != std::string_view::npos && digits[first] != '.';
  }

  /// What controllers compute while a program runs.
  [[noreturn]] double fail_language(const char* what) const {
    std::string text;
    for (const char c : line_.substr(0, line_.find_first_of(";(", at_)).substr(0, kShown)) text += plain(c);
    fail(at_,
         fmt::format("'{}': {} are not read: let the CAM system write the program without them", text, what));
  }

  [[noreturn]] void fail_number(std::size_t word_start) {
    std::size_t end = at_;
    while (end < line_.size() && !is_space(line_[end]) && line_[end] != ';' && line_[end] != '(') ++end;
    std::string text;
    for (const char c : line_.substr(word_start, std::min<std::size_t>(end - word_start, kShown)))
      text += plain(c);
    fail(word_start, fmt::format("'{}': {} needs a finite decimal number", text, upper(line_[word_start])));
  }
  static std::string plain(char c) {
    return c >= 32 && c < 127 ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  static std::string shown(char c) { return "'" + plain(c) + "'"; }
  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    throw InputError({file_, line_number_, static_cast<int>(at) + 1}, message);
  }

  std::string_view line_;
  const std::string& file_;
  int line_number_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<Word> lex_line(std::string_view line, const std::string& file, int line_number) {
  return LineLexer(line, file, line_number).run();
}

}  // namespace understudy::toolpath
