#include "toolpath/gcode/macros/gcode_macros.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text/trimmed.h"
#include "toolpath/gcode/macros/gcode_macro_text.h"

namespace understudy::toolpath {
using namespace macro_text;

namespace {

using Values = std::map<std::string, std::string>;

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// A value of a template: params.BED|default(60)|float.
class Expression {
 public:
  Expression(std::string_view text, const Values& params, const Values& names, Place place)
      : text_(text), params_(params), names_(names), place_(std::move(place)) {}

  std::string value() {
    std::optional<std::string> value = first();
    for (skip_blanks(); at_ < text_.size(); skip_blanks()) {
      if (text_[at_++] != '|') refuse();
      apply(name(), value);
    }
    if (!value)
      throw InputError(place_, fmt::format("'{{{}}}': the call does not give it, and it has no default",
                                           shown(trimmed(text_))));
    return *value;
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError(
        place_, fmt::format("'{{{}}}': of Jinja, {{params.NAME|default(VALUE)}}, int, float and {{% set %}} "
                            "are read: write out what this macro does",
                            shown(trimmed(text_))));
  }
  void skip_blanks() {
    while (at_ < text_.size() && macro_text::is_blank(text_[at_])) ++at_;
  }
  bool take(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::string name() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name(text_[at_])) ++at_;
    if (at_ == begin) refuse();
    return std::string(text_.substr(begin, at_ - begin));
  }
  /// A number, or a text in quotes.
  std::optional<std::string> literal() {
    skip_blanks();
    if (at_ >= text_.size()) return std::nullopt;
    if (const char quote = text_[at_]; quote == '"' || quote == '\'') {
      const std::size_t end = text_.find(quote, at_ + 1);
      if (end == std::string_view::npos) refuse();
      std::string value(text_.substr(at_ + 1, end - at_ - 1));
      at_ = end + 1;
      return value;
    }
    const std::size_t end = std::min(text_.find_first_not_of("+-.0123456789", at_), text_.size());
    const std::string_view digits = text_.substr(at_, end - at_);
    if (!number_of(digits)) return std::nullopt;
    at_ = end;
    return std::string(digits);
  }
  static std::optional<std::string> find(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  /// Nothing: a parameter that the call does not give.
  std::optional<std::string> first() {
    if (auto value = literal()) return value;
    const std::string word = name();
    if (word == "params") {
      if (!take('.')) refuse();
      return find(params_, name());
    }
    auto value = find(names_, word);
    if (!value) refuse();
    return value;
  }
  void apply(const std::string& filter, std::optional<std::string>& value) {
    if (filter == "default") {
      if (!take('(')) refuse();
      const auto otherwise = literal();
      if (!otherwise || !take(')')) refuse();
      if (!value) value = otherwise;
    } else if (filter == "int" || filter == "float") {
      if (!value) return;
      const auto number = number_of(trimmed(*value));
      if (!number)
        throw InputError(place_,
                         fmt::format("'{{{}}}': '{}' is no number", shown(trimmed(text_)), shown(*value)));
      value = filter == "int" ? fmt::format("{:.0f}", std::trunc(*number)) : fmt::format("{}", *number);
    } else {
      refuse();
    }
  }

  std::string_view text_;
  const Values &params_, &names_;
  Place place_;
  std::size_t at_ = 0;
};

/// M600 X1Y2: there a value ends at the next letter.
std::size_t value_end(std::string_view text, bool in_words) {
  const auto ends = [&](char c) {
    return macro_text::is_blank(c) || (!in_words && std::isalpha(static_cast<unsigned char>(c)) != 0);
  };
  return static_cast<std::size_t>(std::find_if(text.begin(), text.end(), ends) - text.begin());
}

class Template {
 public:
  Template(Values params, const std::vector<std::string>& files)
      : params_(std::move(params)), files_(files) {}

  /// The line with its values; of {% set %} nothing is left.
  std::string fill(const MacroLine& line) {
    const Place place{files_[line.file], line.number};
    std::string_view rest = line.text;
    std::string result;
    while (true) {
      const std::size_t open = rest.find('{');
      result += rest.substr(0, open);
      if (result.size() > kGcodeLineMax)
        throw InputError(place,
                         fmt::format("with its values, the line has more than {} bytes", kGcodeLineMax));
      if (open == std::string_view::npos) return result;
      rest.remove_prefix(open);
      const bool statement = rest.starts_with("{%");
      const std::size_t close = rest.find(statement ? "%}" : "}");
      if (close == std::string_view::npos)
        throw InputError(place, fmt::format("'{}': the template is not closed on its line", shown(rest)));
      const std::size_t edge = statement ? 2 : 1;
      const std::string_view inside = rest.substr(edge, close - edge);
      if (statement)
        set(inside, place);
      else
        result += Expression(inside, params_, names_, place).value();
      rest.remove_prefix(close + edge);
    }
  }

 private:
  /// "set NAME = EXPRESSION"
  void set(std::string_view statement, const Place& place) {
    std::string_view rest = trimmed(statement);
    const std::size_t equals = rest.find('=');
    const bool is_set = rest.starts_with("set ") && equals != std::string_view::npos;
    const std::string name(is_set ? trimmed(rest.substr(4, equals - 4)) : "");
    if (name.empty() || !std::all_of(name.begin(), name.end(), is_name))
      throw InputError(
          place, fmt::format("'{{%{}%}}': of Jinja's statements, {{% set NAME = VALUE %}} is read: write "
                             "out what this macro does",
                             shown(statement)));
    names_[name] = Expression(rest.substr(equals + 1), params_, names_, place).value();
  }

  Values params_, names_;
  const std::vector<std::string>& files_;
};

/// A line of so many bytes.
void take(MacroBudget& left, std::size_t bytes, const Place& place) {
  if (left.lines == 0)
    throw InputError(place,
                     fmt::format("macros make more than {} lines of one program", MacroBudget().lines));
  if (left.bytes < bytes)
    throw InputError(place,
                     fmt::format("macros make more than {} bytes of one program", MacroBudget().bytes));
  --left.lines;
  left.bytes -= bytes;
}

}  // namespace

Values call_parameters(const std::string& command, std::string_view call, const Place& place) {
  call = call.substr(0, call.find_first_of(";#*"));
  const std::size_t begin = upper(call).find(command) + command.size();
  call.remove_prefix(std::min(begin, call.size()));
  const bool in_words = command.size() == 1 || std::isdigit(static_cast<unsigned char>(command[1])) == 0;
  Values values;
  while (!(call = trimmed(call)).empty()) {
    const std::size_t name_end = in_words ? std::min(call.find_first_of("= \t"), call.size()) : 1;
    const std::string name = upper(call.substr(0, name_end));
    call.remove_prefix(name_end);
    if (in_words && !call.starts_with('='))
      throw InputError(place,
                       fmt::format("'{}' in the call of {}: NAME=VALUE is needed", shown(name), command));
    if (in_words) call.remove_prefix(1);
    const bool quoted = call.starts_with('"') && call.find('"', 1) != std::string_view::npos;
    const std::size_t from = quoted ? 1 : 0;
    const std::size_t end = quoted ? call.find('"', 1) : value_end(call, in_words);
    values[name] = std::string(call.substr(from, end - from));
    call.remove_prefix(std::min(end + from, call.size()));
  }
  return values;
}

std::vector<MacroLine> GcodeMacros::expand(const std::string& command, std::string_view call,
                                           MacroBudget& left) const {
  const std::vector<MacroLine>& lines = macros_.at(command);
  if (lines.empty()) return {};
  const Place place{files_[lines.front().file], lines.front().number};
  Template filled(call_parameters(command, call, place), files_);
  std::vector<MacroLine> result;
  for (const MacroLine& line : lines) {
    std::string text = filled.fill(line);
    take(left, text.size(), {files_[line.file], line.number});
    if (!trimmed(text).empty()) result.push_back({std::move(text), line.number, line.file});
  }
  return result;
}

}  // namespace understudy::toolpath
