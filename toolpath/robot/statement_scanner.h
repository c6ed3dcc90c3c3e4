// Private to this folder: the characters of a statement, for readers of both languages.
#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace understudy::toolpath {

/// Upper case of ASCII letters; both languages take them as small ones.
std::string upper_case(std::string_view text);

class StatementScanner {
 public:
  StatementScanner(std::string_view text, const Place& place) : text_(text), place_(place) {}

  /// Behind blanks.
  bool at_end();
  char peek();
  /// Whether `c` comes next, which is then behind.
  bool take(char c);
  void expect(char c);
  /// A name of letters, digits, _ and $, upper case; empty: none comes next.
  std::string name();
  const std::string& spelled() const { return spelled_; }  ///< the last name as it is written
  /// Whether the name `word` (upper case) comes next, which is then behind.
  bool take_name(std::string_view word);
  bool begins_number();
  /// Digits with a point and an exponent, without a sign.
  double number();
  std::string quoted();  ///< without its quotes
  /// What is left.
  std::string_view rest();

  /// Guards recursion: throws InputError where brackets nest too deep.
  class Deeper {
   public:
    explicit Deeper(StatementScanner& scanner);
    ~Deeper() { --scanner_.depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

   private:
    StatementScanner& scanner_;
  };

  const Place& place() const { return place_; }
  /// Names what comes next.
  [[noreturn]] void fail(const std::string& expected);

 private:
  void skip_blanks();

  std::string_view text_;
  Place place_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::string spelled_;
};

/// Operands of equal rank between `operations`, from the left: `operand()` reads one, `calculate(operation,
/// a, b)` joins two.
template <class Operand, class Calculate>
auto scan_row(StatementScanner& scanner, std::string_view operations, const Operand& operand,
              const Calculate& calculate) {
  auto value = operand();
  for (std::size_t i = operations.find(scanner.peek()); i != std::string_view::npos;
       i = operations.find(scanner.peek())) {
    scanner.expect(operations[i]);
    value = calculate(operations[i], value, operand());
  }
  return value;
}

}  // namespace understudy::toolpath
