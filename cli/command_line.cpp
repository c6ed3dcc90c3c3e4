#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "core/text/shell_quoted.h"

namespace understudy::cli {
namespace {

std::string remembered;

}  // namespace

std::string shell_quoted(std::string_view word) { return understudy::shell_quoted(word); }

void remember_command_line(int argc, char** argv) {
  remember_command_line(std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
}

void remember_command_line(const std::vector<std::string>& words) {
  remembered = "understudy";
  for (const std::string& word : words) remembered += " " + shell_quoted(word);
}

void restore_command_line(const std::string& line) { remembered = line; }

const std::string& command_line() { return remembered; }

std::vector<std::string> split_command_line(const std::string& line) {
  std::vector<std::string> words;
  bool in_word = false, in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == ' ' && !in_quotes) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == '\'')
      in_quotes = !in_quotes;
    else
      words.back() += c == '\\' && !in_quotes && i + 1 < line.size() ? line[++i] : c;
  }
  return words;
}

}  // namespace understudy::cli
