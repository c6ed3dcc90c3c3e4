#include "toolpath/gcode/gcode_salvage.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace understudy::toolpath {
namespace {

constexpr std::string_view kMoveLetters = "XYZEFIJKWPQRS";
constexpr std::string_view kProcessLetters = "SPR";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool has(std::string_view all, char c) { return all.find(c) != std::string_view::npos; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// A letter and what follows it up to the next letter or blank; blanks ahead of a number count for nothing.
struct Piece {
  char letter = 0;
  std::string_view text;
  std::optional<double> value;
};

/// Nothing: characters that no text has, or the language of controllers.
std::optional<std::vector<Piece>> pieces_of(std::string_view line) {
  std::vector<Piece> pieces;
  line = line.substr(0, std::min(line.find(';'), line.find('(')));
  if (std::ranges::any_of(line, [](char c) { return (c < 32 && !is_blank(c)) || c > 126 || has("#[]", c); }))
    return std::nullopt;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = at++;
    if (is_blank(line[begin])) continue;
    if (!is_letter(line[begin])) {
      if (pieces.empty()) return std::nullopt;
      pieces.back().value.reset();  // what stands there may belong to it
      continue;
    }
    while (at < line.size() && is_blank(line[at])) ++at;
    const std::size_t digits = at;
    while (at < line.size() && !is_letter(line[at]) && !is_blank(line[at])) ++at;
    // X1e-06, as the lexer has it.
    if (at > digits && at < line.size() && line[at] == 'e' && line[begin] < 'a')
      at = std::min(line.find_first_not_of("+-.0123456789", at + 1), line.size());
    pieces.push_back(
        {upper(line[begin]), line.substr(begin, at - begin), number_of(line.substr(digits, at - digits))});
  }
  return pieces;
}

struct Commands {
  int moves = 0, others = 0;
  bool arc = false;
};

bool is_command(char letter) { return letter == 'G' || letter == 'M'; }

/// Nothing: commands that change what later lines mean, or that cannot be read.
std::optional<Commands> commands_of(const std::vector<Piece>& pieces) {
  Commands commands;
  const Piece* motion = nullptr;
  for (const Piece& piece : pieces) {
    if (!is_command(piece.letter)) continue;
    const Meaning* meaning = piece.value ? meaning_of(piece.letter, *piece.value) : nullptr;
    if (meaning == nullptr) return std::nullopt;
    switch (meaning->command) {
      case Command::rapid:
      case Command::linear:
      case Command::clockwise_arc:
      case Command::counterclockwise_arc:
      case Command::spline:
        if (motion != nullptr && *motion->value != *piece.value) return std::nullopt;
        motion = &piece;
        ++commands.moves;
        commands.arc = *piece.value > 1;
        break;
      case Command::machine_position:
        break;
      case Command::dwell:
      case Command::heat:
      case Command::heat_and_wait:
      case Command::fan_on:
      case Command::fan_off:
        ++commands.others;
        break;
      default:
        return std::nullopt;
    }
  }
  return commands;
}

/// As the dialect reads it: E of filament, else the letter; nothing for one that is not of this machine.
std::optional<char> meaning_letter(char letter, const Letters& letters) {
  if (letter == letters.extruder) return 'E';
  if (letter == 'E') return std::nullopt;
  if (has(letters.rotary, letter) || has(kMoveLetters, letter)) return letter;
  return std::nullopt;
}

class MovingLine {
 public:
  MovingLine(const Letters& letters, bool arc) : letters_(letters), arc_(arc) { result_.moves = true; }

  bool add(const Piece& piece) {
    if (is_command(piece.letter)) {
      const bool first = std::ranges::none_of(
          result_.words, [&](const Word& w) { return w.letter == piece.letter && w.value == *piece.value; });
      if (first) result_.words.push_back({piece.letter, *piece.value, piece.text, 1});
      return true;
    }
    const auto meaning = meaning_letter(piece.letter, letters_);
    if (!meaning) return false;
    const bool turns = has(letters_.rotary, *meaning);
    if (!turns && has(arc_ ? "IJKPQRS" : "PQRS", *meaning)) return true;  // of the way, not of its end
    const char about = about_of(*meaning);
    const bool twice =
        std::ranges::any_of(result_.words, [&](const Word& w) { return w.letter == piece.letter; });
    if (*meaning != 'F') note(about, result_.named);
    if (*meaning != 'F' && (!piece.value || twice)) note(about, result_.lost);
    if (twice)
      std::erase_if(result_.words, [&](const Word& w) { return w.letter == piece.letter; });
    else if (piece.value)
      result_.words.push_back({piece.letter, *piece.value, piece.text, 1});
    return true;
  }

  SalvagedLine finish(bool two_moves) {
    // Of an orientation all is read or nothing. Of two moves on one line none is.
    if (two_moves) result_.lost = result_.named;
    std::erase_if(result_.words, [&](const Word& w) {
      if (is_command(w.letter) || w.letter == 'F') return two_moves && w.letter == 'F';
      return has(result_.lost, about_of(*meaning_letter(w.letter, letters_)));
    });
    result_.arc = arc_;
    return std::move(result_);
  }

 private:
  char about_of(char meaning) const {
    const auto turn = letters_.rotary.find(meaning);
    if (turn != std::string::npos) return "BC"[turn];
    return has("WIJK", meaning) ? 'W' : meaning;
  }
  static void note(char letter, std::string& letters) {
    if (!has(letters, letter)) letters += letter;
  }

  const Letters& letters_;
  bool arc_;
  SalvagedLine result_;
};

}  // namespace

std::optional<SalvagedLine> salvage(std::string_view line, const Letters& letters, bool arc) {
  auto pieces = pieces_of(line);
  if (pieces && !pieces->empty() && pieces->front().letter == 'N') pieces->erase(pieces->begin());
  if (!pieces || pieces->empty()) return std::nullopt;
  const auto commands = commands_of(*pieces);
  if (!commands || (commands->moves > 0 && commands->others > 0)) return std::nullopt;
  if (commands->others > 0) {
    const bool known = std::ranges::all_of(
        *pieces, [](const Piece& p) { return is_command(p.letter) || has(kProcessLetters, p.letter); });
    return known ? std::optional(SalvagedLine{}) : std::nullopt;
  }
  MovingLine moving(letters, commands->moves > 0 ? commands->arc : arc);
  for (const Piece& piece : *pieces)
    if (!moving.add(piece)) return std::nullopt;
  return moving.finish(commands->moves > 1);
}

}  // namespace understudy::toolpath
