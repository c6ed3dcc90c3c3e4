#include "toolpath/gcode/gcode_command.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>

#include <fmt/format.h>

#include "core/error.h"
#include "toolpath/gcode/words/gcode_words.h"

namespace understudy::toolpath {

int column_of(std::string_view line) { return static_cast<int>(line.find_first_not_of(" \t")) + 1; }

std::string first_command(std::string_view line) {
  if (const std::string word = command_in_words(line); !word.empty()) return word;
  const std::size_t start = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t end = std::min(line.find_first_not_of("0123456789.", start + 1), line.size());
  std::string word(line.substr(start, end - start));
  if (!word.empty()) word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

bool has_meaning(const std::string& command) {
  if (command.size() < 2 || std::isdigit(static_cast<unsigned char>(command[1])) == 0) return false;
  const double number = std::strtod(command.c_str() + 1, nullptr);
  return meaning_of(command[0], number) != nullptr || without_effect(command[0], number) != nullptr;
}

Letters letters_of(const GcodeOptions& options) {
  Letters letters;
  letters.extruder = options.extruder_letter;
  if (!options.rotary) return letters;
  letters.rotary = options.rotary->letters;
  letters.tip_commands = options.rotary->tip_commands;
  letters.machine_commands = options.rotary->machine_commands;
  for (const auto* commands : {&letters.tip_commands, &letters.machine_commands})
    for (const std::string& command : *commands) {
      double number = 0;
      const char* end = command.data() + command.size();
      const bool coded = (command[0] == 'G' || command[0] == 'M') &&
                         std::from_chars(command.data() + 1, end, number).ptr == end;
      const Meaning* meaning = coded ? meaning_of(command[0], number) : nullptr;
      if ((meaning != nullptr && meaning->group != Group::coordinates) ||
          (coded && without_effect(command[0], number) != nullptr) || is_line_without_effect(command))
        throw InputError(
            fmt::format("'{}' cannot switch tool-centre-point control: it has another meaning", command));
    }
  return letters;
}

}  // namespace understudy::toolpath
