#include "toolpath/robot/rapid_text.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "toolpath/robot/statement_scanner.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kStatementMax = 65'536;  // [bytes]; docs/limits.md

constexpr std::string_view kAlone[] = {"ENDPROC", "ENDMODULE", "ENDFUNC", "ENDTRAP", "ENDRECORD", "ENDIF",
                                       "ENDFOR",  "ENDWHILE",  "ENDTEST", "ELSE",    "UNDO",      "ERROR"};

bool is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The header %%% VERSION:1 LANGUAGE:ENGLISH %%% of some files.
void blank_header(std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || text.compare(begin, 3, "%%%") != 0) return;
  const std::size_t end = text.find("%%%", begin + 3);
  if (end == std::string::npos) return;
  std::replace_if(
      text.begin() + static_cast<std::ptrdiff_t>(begin), text.begin() + static_cast<std::ptrdiff_t>(end + 3),
      [](char c) { return c != '\n'; }, ' ');
}

/// Blanks in their place.
void blank_comments(std::string& text, const std::string& file) {
  if (text.starts_with("\xef\xbb\xbf")) std::fill_n(text.begin(), 3, ' ');
  blank_header(text);
  bool quoted = false, comment = false;
  int line = 1;
  for (char& c : text) {
    if (c == '\n') {
      ++line;
      quoted = comment = false;
      continue;
    }
    if (static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\r')
      throw InputError(Place{file, line}, fmt::format("byte {} belongs to no program", static_cast<int>(c)));
    if (c == '"') quoted = !quoted && !comment;
    if (c == '!' && !quoted) comment = true;
    if (comment) c = ' ';
  }
}

class Splitter {
 public:
  Splitter(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::vector<RapidStatement> run() {
    std::vector<RapidStatement> statements;
    for (skip_blanks(); at_ < text_.size(); skip_blanks()) {
      if (text_[at_] == ';') {
        ++at_;
        continue;
      }
      statements.push_back(next());
    }
    return statements;
  }

 private:
  void skip_blanks() {
    for (; at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos;
         ++at_)
      if (text_[at_] == '\n') ++line_;
  }

  RapidStatement next() {
    RapidStatement statement;
    statement.line = line_;
    start_ = at_;
    statement.word = word();
    if (statement.word == "LOCAL" || statement.word == "TASK") {
      skip_blanks();
      const std::size_t before = at_;
      const std::string second = word();
      if (is_routine(second))
        statement.word = second;
      else
        at_ = before;
    }
    finish(statement.word);
    statement.text = text_.substr(start_, at_ - start_);
    if (at_ < text_.size() && text_[at_] == ';') ++at_;
    return statement;
  }

  static bool is_routine(const std::string& word) {
    return word == "PROC" || word == "FUNC" || word == "TRAP";
  }

  std::string word() {
    const std::size_t start = at_;
    while (at_ < text_.size() && is_name(text_[at_])) ++at_;
    return upper_case(text_.substr(start, at_ - start));
  }

  void finish(const std::string& word) {
    if (std::find(std::begin(kAlone), std::end(kAlone), word) != std::end(kAlone)) return;
    if (word == "MODULE" || word == "TRAP" || word == "TEST") return to_line_end();
    if (word == "PROC" || word == "FUNC") return behind(")");
    if (word == "IF" || word == "ELSEIF") return to_word("THEN");
    if (word == "FOR" || word == "WHILE") return to_word("DO");
    if (word == "CASE" || word == "DEFAULT") return behind(":");
    to_word("");
  }

  /// Also a newline within is counted.
  void step() {
    if (text_[at_] == '\n') ++line_;
    if (++at_ - start_ > kStatementMax)
      throw InputError(Place{file_, line_}, fmt::format("a statement of more than {} bytes", kStatementMax));
  }

  void to_line_end() {
    while (at_ < text_.size() && text_[at_] != '\n') step();
  }

  void behind(std::string_view end) {
    while (at_ < text_.size() && text_[at_] != end.front()) step();
    if (at_ == text_.size()) fail(std::string(end));
    step();
  }

  /// To the semicolon, or behind `end` where that comes first.
  void to_word(std::string_view end) {
    for (bool quoted = false; at_ < text_.size();) {
      const char c = text_[at_];
      if (c == '"') quoted = !quoted;
      if (c == '\n') quoted = false;
      if (c == ';' && !quoted) return;
      if (!quoted && !end.empty() && is_name(c) && !is_name(text_[at_ - 1])) {
        const std::size_t before = at_;
        if (word() == end) return;
        if (at_ - start_ > kStatementMax) at_ = before + 1;
        continue;
      }
      step();
    }
    fail(end.empty() ? ";" : std::string(end));
  }

  [[noreturn]] void fail(const std::string& end) const {
    throw InputError(Place{file_, line_}, fmt::format("the last statement has no '{}'", end));
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0, start_ = 0;
  int line_ = 1;
};

}  // namespace

std::vector<RapidStatement> rapid_statements(std::string& text, const std::string& file) {
  blank_comments(text, file);
  return Splitter(text, file).run();
}

}  // namespace understudy::toolpath
