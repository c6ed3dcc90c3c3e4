#include <string>
#include <string_view>

#include "cli/command.h"

namespace understudy::cli {
namespace {

std::string remembered;

std::string quoted(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

void remember_command_line(int argc, char** argv) {
  remembered = "understudy";
  for (int i = 1; i < argc; ++i) remembered += " " + quoted(argv[i]);
}

const std::string& command_line() { return remembered; }

}  // namespace understudy::cli
