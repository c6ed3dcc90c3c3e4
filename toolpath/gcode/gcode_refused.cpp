#include "toolpath/gcode/gcode_refused.h"

#include <cctype>
#include <cstdlib>

#include "toolpath/gcode/words/gcode_words.h"

namespace understudy::toolpath {

void RefusedLines::add(const InputError& error, const std::string& command) {
  ++lines;
  if (told.size() < static_cast<std::size_t>(kMostRefused))
    told.push_back({error.place().line, error.place().column, command, without_place(error)});
}

std::string without_place(const InputError& error) {
  const std::string place = to_string(error.place()), text = error.what();
  return place.empty() || !text.starts_with(place) ? text : text.substr(place.size() + 2);
}

bool can_be_ignored(std::string_view command) {
  if (command.size() < 2) return false;
  if (std::isdigit(static_cast<unsigned char>(command[1])) == 0) return true;  // a word
  if (command[0] != 'G' && command[0] != 'M') return false;
  return meaning_of(command[0], std::strtod(std::string(command.substr(1)).c_str(), nullptr)) == nullptr;
}

}  // namespace understudy::toolpath
