#include "toolpath/gcode/gcode_macros.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"

namespace understudy::toolpath {
namespace {

using Values = std::map<std::string, std::string>;

constexpr std::string_view kMacro = "gcode_macro";
constexpr std::size_t kShown = 60;  // characters of a template in a message

char upper(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }
std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) { return upper(c); });
  return result;
}
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string shown(std::string_view text) {
  std::string plain(text.substr(0, kShown));
  for (char& c : plain)
    if (c < 32 || c > 126) c = '?';
  return plain;
}

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
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
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
    return is_blank(c) || (!in_words && std::isalpha(static_cast<unsigned char>(c)) != 0);
  };
  return static_cast<std::size_t>(std::find_if(text.begin(), text.end(), ends) - text.begin());
}

/// Of a call: "BED=60 NAME="a b"", or of a letter with a number "X10 Y5".
Values parameters(const std::string& command, std::string_view call, const Place& place) {
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

class Template {
 public:
  Template(Values params, const std::string& file) : params_(std::move(params)), file_(file) {}

  /// The line with its values; of {% set %} nothing is left.
  std::string fill(const MacroLine& line) {
    const Place place{file_, line.number};
    std::string_view rest = line.text;
    std::string result;
    while (true) {
      const std::size_t open = rest.find('{');
      result += rest.substr(0, open);
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
  std::string file_;
};

/// Lines of the file to macros.
class FileParser {
 public:
  FileParser(const std::string& file, std::map<std::string, std::vector<MacroLine>>& macros)
      : file_(file), macros_(macros) {}

  void add(std::string_view line, int number) {
    line = line.substr(0, line.find('#'));
    const std::string_view words = trimmed(line);
    if (words.empty() || words.front() == ';') return;
    if (line.front() == '[')
      begin_section(words, number);
    else if (is_blank(line.front()))
      go_on(words, number);
    else
      begin_key(words, number);
  }

 private:
  [[noreturn]] void fail(int number, const std::string& message) const {
    throw InputError(Place{file_, number}, message);
  }

  void begin_section(std::string_view words, int number) {
    if (words.back() != ']') fail(number, fmt::format("'{}': the section has no ']'", shown(words)));
    std::string_view name = words.substr(1, words.size() - 2);
    in_section_ = true;
    macro_ = nullptr;
    in_gcode_ = false;
    if (!name.starts_with(kMacro) || (name.size() > kMacro.size() && !is_blank(name[kMacro.size()]))) return;
    name = trimmed(name.substr(kMacro.size()));
    if (name.empty() || !std::all_of(name.begin(), name.end(), [](char c) { return is_name(c) || c == '.'; }))
      fail(number, fmt::format("'{}': a macro's name has letters, digits and '_'", shown(words)));
    const auto [entry, is_new] = macros_.try_emplace(upper(name));
    if (!is_new) fail(number, fmt::format("'{}' is there a second time", entry->first));
    macro_ = &entry->second;
  }

  void begin_key(std::string_view words, int number) {
    const std::size_t end = words.find_first_of(":=");
    if (!in_section_ || end == std::string_view::npos)
      fail(number, fmt::format("'{}' is no [section] and no 'key: value' of one", shown(words)));
    in_gcode_ = macro_ != nullptr && trimmed(words.substr(0, end)) == "gcode";
    if (const std::string_view value = trimmed(words.substr(end + 1)); in_gcode_ && !value.empty())
      go_on(value, number);
  }

  void go_on(std::string_view words, int number) {
    if (in_gcode_) macro_->push_back({std::string(words.substr(0, words.find(';'))), number});
  }

  const std::string& file_;
  std::map<std::string, std::vector<MacroLine>>& macros_;
  std::vector<MacroLine>* macro_ = nullptr;  // null: in another section
  bool in_section_ = false, in_gcode_ = false;
};

}  // namespace

std::vector<MacroLine> GcodeMacros::expand(const std::string& command, std::string_view call) const {
  const std::vector<MacroLine>& lines = macros_.at(command);
  const Place place{file_, lines.empty() ? 0 : lines.front().number};
  Template filled(parameters(command, call, place), file_);
  std::vector<MacroLine> result;
  for (const MacroLine& line : lines)
    if (std::string text = filled.fill(line); !trimmed(text).empty())
      result.push_back({std::move(text), line.number});
  return result;
}

GcodeMacros GcodeMacros::parse(const std::string& text, const std::string& file) {
  GcodeMacros result;
  result.file_ = file;
  FileParser parser(result.file_, result.macros_);
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    parser.add(rest.substr(0, end), number);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return result;
}

GcodeMacros GcodeMacros::read(const std::filesystem::path& path) {
  return parse(read_file(path), path.string());
}

}  // namespace understudy::toolpath
