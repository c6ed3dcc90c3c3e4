#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/Error.hpp>

#include "cli/command.h"
#include "core/text/shell_quoted.h"

namespace understudy::cli {
namespace {

std::string remembered;

void check_number(const CLI::Option& option, const std::string& word) {
  if (word.empty())
    throw CLI::ConversionError(fmt::format("{}: an empty word is no number", option.get_name()));
  // Others say themselves that the word is no number.
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (*end == '\0' && !std::isfinite(value))
    throw CLI::ConversionError(fmt::format("{}: '{}' is not finite", option.get_name(), word));
}

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

void check_numbers(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (!type.starts_with("FLOAT") && !type.starts_with("INT") && !type.starts_with("UINT")) continue;
    for (const std::string& word : option->results()) check_number(*option, word);
  }
  for (const CLI::App* command : app.get_subcommands()) check_numbers(*command);
}

}  // namespace understudy::cli
