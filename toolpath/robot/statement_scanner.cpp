#include "toolpath/robot/statement_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace understudy::toolpath {
namespace {

constexpr int kDeepest = 20;
constexpr std::size_t kShown = 40;
constexpr std::size_t kLongestName = 200;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

StatementScanner::Deeper::Deeper(StatementScanner& scanner) : scanner_(scanner) {
  if (++scanner_.depth_ > kDeepest)
    throw InputError(scanner_.place_, fmt::format("brackets nest more than {} deep", kDeepest));
}

void StatementScanner::skip_blanks() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}

bool StatementScanner::at_end() {
  skip_blanks();
  return at_ == text_.size();
}

char StatementScanner::peek() { return at_end() ? '\0' : text_[at_]; }

bool StatementScanner::take(char c) {
  if (at_end() || text_[at_] != c) return false;
  ++at_;
  return true;
}

void StatementScanner::expect(char c) {
  if (!take(c)) fail(fmt::format("'{}'", c));
}

std::string StatementScanner::name() {
  if (!is_letter(peek())) return "";
  const std::size_t start = at_;
  while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
  if (at_ - start > kLongestName)
    throw InputError(place_, fmt::format("a name of {} characters", at_ - start));
  spelled_ = text_.substr(start, at_ - start);
  return upper_case(spelled_);
}

bool StatementScanner::take_name(std::string_view word) {
  skip_blanks();
  const std::size_t start = at_;
  if (name() == word) return true;
  at_ = start;
  return false;
}

bool StatementScanner::begins_number() {
  const char c = peek();
  return is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]));
}

double StatementScanner::number() {
  skip_blanks();
  double value = 0;
  const char* first = text_.data() + at_;
  const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
  const bool begins = begins_number();
  // Below what a double holds it is zero.
  if (!begins || (error != std::errc() && error != std::errc::result_out_of_range)) fail("a number");
  const std::size_t length = static_cast<std::size_t>(end - first);
  const bool tiny = std::string_view(first, length).find("e-") != std::string_view::npos ||
                    std::string_view(first, length).find("E-") != std::string_view::npos;
  if (error == std::errc::result_out_of_range) {
    if (!tiny) fail("a finite number");
    value = 0;
  }
  at_ += length;
  if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.')) fail("the end of a number");
  return value;
}

std::string StatementScanner::quoted() {
  expect('"');
  const std::size_t close = text_.find('"', at_);
  if (close == std::string_view::npos) fail("the text's closing '\"'");
  const std::string text(text_.substr(at_, close - at_));
  at_ = close + 1;
  return text;
}

std::string_view StatementScanner::rest() {
  skip_blanks();
  return text_.substr(at_);
}

void StatementScanner::fail(const std::string& expected) {
  const std::string_view left = rest();
  throw InputError(place_, left.empty() ? fmt::format("{} is missing at the end of the statement", expected)
                                        : fmt::format("'{}{}': {} is expected", left.substr(0, kShown),
                                                      left.size() > kShown ? "..." : "", expected));
}

}  // namespace understudy::toolpath
