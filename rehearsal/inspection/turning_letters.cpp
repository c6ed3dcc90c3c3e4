#include "rehearsal/inspection/turning_letters.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>

#include "core/text/take_line.h"
#include "core/text/trimmed.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/words/gcode_words.h"

namespace understudy::rehearsal {
namespace {

constexpr std::string_view kOfNumbers = "0123456789.-+";
constexpr std::size_t kMostLetters = 2;  // that a machine's words may have

char capital(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }

/// Letters and their numbers, of a line that begins with G or N; nothing for any other.
void for_each_word(std::string_view line, const std::function<void(char, double)>& see) {
  line = trimmed(line.substr(0, line.find_first_of(";(")));
  if (line.empty() || (capital(line[0]) != 'G' && line[0] != 'N')) return;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    if (kOfNumbers.find(line[i + 1]) != std::string_view::npos &&
        std::isalpha(static_cast<unsigned char>(line[i])))
      see(capital(line[i]), std::strtod(std::string(line.substr(i + 1, 32)).c_str(), nullptr));
}

bool is_homing_or_levelling(char letter, double number) {
  return letter == 'G' && (number == 28 || toolpath::without_effect('G', number) != nullptr);
}

}  // namespace

std::set<char> letters_of(std::string_view text) {
  std::set<char> letters;
  while (!text.empty()) for_each_word(take_line(text), [&](char letter, double) { letters.insert(letter); });
  return letters;
}

std::string turning_letters(std::string_view text, char extruder) {
  std::set<char> stated, turned;
  while (!text.empty()) {
    bool moves = true;
    for_each_word(take_line(text), [&](char letter, double number) {
      if (is_homing_or_levelling(letter, number)) moves = false;
      if (!moves) return;
      stated.insert(letter);
      if (number != 0) turned.insert(letter);
    });
  }
  const auto turning = [&](const std::set<char>& letters) {
    std::string found;
    for (const char letter : std::string_view(toolpath::kRotaryLetters))
      if (letters.contains(letter) && letter != extruder && !(letter == 'W' && stated.contains('K')))
        found += letter;
    return found;
  };
  const std::string all = turning(stated), some = turning(turned);
  return some.empty() || all.size() > kMostLetters ? some : all;
}

std::string without_words(std::string_view text, std::string_view letters) {
  std::string result;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const std::size_t comment = std::min(line.find_first_of(";("), line.size());
    for (std::size_t i = 0; i < line.size();) {
      if (i < comment && letters.find(capital(line[i])) != std::string_view::npos && i + 1 < comment &&
          kOfNumbers.find(line[i + 1]) != std::string_view::npos)
        i = std::min(line.find_first_not_of(kOfNumbers, i + 1), line.size());
      else
        result += line[i++];
    }
    result += '\n';
  }
  return result;
}

}  // namespace understudy::rehearsal
