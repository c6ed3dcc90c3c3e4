#include "toolpath/gcode/rewrite/gcode_rewrite.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text/take_line.h"
#include "core/units.h"
#include "toolpath/gcode/gcode_line_reader.h"
#include "toolpath/gcode/words/gcode_number.h"

namespace understudy::toolpath {
namespace {

constexpr int kLengthDigits = 6, kOrientationDigits = 9, kFeedDigits = 12;
constexpr double kSameTurn = 1e-9;    // [rad], what the words of an orientation keep
constexpr double kSamePlace = 5e-8;   // [m]: the digits above, in inches, and of turns on an arm of 0.5 m
constexpr double kLeastShare = 1e-9;  // of a line's time

/// A word as it is written anew, in the dialect's own letters.
struct NewWord {
  char letter = 0;
  std::string number;
};

std::string text_of(const NewWord& word) { return word.letter + word.number; }

/// Commands whose meaning reaches the other words of their line.
bool is_mode(const Word& word, const Letters& letters) {
  if ((word.letter != 'G' && word.letter != 'M') || word.bare || word.quoted) return false;
  if (letters.switching(word.letter, word.value)) return true;
  const Meaning* meaning = meaning_of(word.letter, word.value);
  if (meaning == nullptr) return false;
  switch (meaning->group) {
    case Group::units:
    case Group::coordinates:
    case Group::work_offset:
    case Group::distance:
    case Group::feed_mode:
    case Group::extrusion:
      return true;
    default:
      return false;
  }
}

bool is_curve_code(const Word& word) {
  return word.letter == 'G' && !word.bare && (word.value == 2 || word.value == 3 || word.value == 5);
}

/// One line that moves, and the words of its pieces.
class PlacedLine {
 public:
  PlacedLine(std::string_view text, std::vector<Word> words, const Letters& letters, bool curve)
      : text_(text), words_(std::move(words)), letters_(letters), curve_(curve) {}

  const Word* find(char letter) const {
    const auto word = std::ranges::find(words_, letter, &Word::letter);
    return word == words_.end() ? nullptr : &*word;
  }
  const Word* filament() const { return find(letters_.extruder); }
  bool in_machine() const {
    return std::ranges::any_of(words_, [](const Word& w) { return w.letter == 'G' && w.value == 53; });
  }
  bool states_orientation() const { return !curve_ && find('I') != nullptr; }

  std::string modes() const {
    std::string text;
    for (const Word& word : words_)
      if (is_mode(word, letters_)) text += fmt::format("{} ", word.text);
    return text;
  }

  /// The line with `words` in the place of its own; those that it has not follow its last of a place.
  std::string with(std::vector<NewWord> words) const {
    std::string out;
    std::size_t at = 0, insert_at = 0;
    bool straight = !curve_;
    for (const Word& word : words_) {
      const auto start = static_cast<std::size_t>(word.column) - 1;
      out += text_.substr(at, start - at);
      at = start + word.text.size();
      const auto anew = std::ranges::find(words, word.letter, &NewWord::letter);
      if (curve_ && is_curve_code(word)) {
        out += "G1";
        straight = true;
      } else if (anew != words.end()) {
        out += text_of(*anew);
        words.erase(anew);
      } else if (says_place(word)) {
        out.erase(out.find_last_not_of(' ') + 1);
        continue;
      } else {
        out += word.text;
      }
      if (says_place(word) || word.letter == 'G' || word.letter == 'N') insert_at = out.size();
    }
    std::string missing = straight ? "" : " G1";
    for (const NewWord& word : words) missing += " " + text_of(word);
    if (insert_at == 0 && !missing.empty()) missing = missing.substr(1) + " ";
    out.insert(insert_at, missing);
    return out.append(text_.substr(at));
  }

 private:
  bool says_place(const Word& word) const {
    const std::string_view plain = curve_ ? "XYZIJKRPQ" : "XYZIJKW";
    return plain.find(word.letter) != std::string_view::npos ||
           letters_.rotary.find(word.letter) != std::string::npos;
  }

  std::string_view text_;
  std::vector<Word> words_;
  const Letters& letters_;
  bool curve_;
};

class Rewriter {
 public:
  Rewriter(const std::string& file, const GcodeOptions& options, const MovedLines& moved)
      : file_(file), moved_(moved), original_(file, options, steps_), written_(file, options, steps_) {}

  void add(std::string_view line, int number, std::string_view end) {
    original_.read(line, number);
    const auto moved = moved_.find(number);
    if (moved == moved_.end() || moved->second.empty()) {
      written_.read(line, number);
      out_ += line;
    } else {
      place(line, number, moved->second, end.empty() ? "\n" : end);
    }
    out_ += end;
    steps_.clear();
  }

  std::string finish() {
    original_.finish();
    written_.finish();
    return std::move(out_);
  }

 private:
  void place(std::string_view text, int number, const std::vector<MovedPiece>& pieces, std::string_view end) {
    const PlacedLine line(text, lex_line(text, file_, number), written_.letters(),
                          original_.state().on_curve());
    if (const std::string modes = line.modes(); !modes.empty()) written_.read(modes, number);
    const Word *e = line.filament(), *f = line.find('F');
    const double e_before = written_.state().extruder_reading();
    double e_said = 0, share_before = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      std::vector<NewWord> words = place_words(pieces[i], line);
      if (pieces.size() > 1) {
        if (e != nullptr) words.push_back(filament(*e, pieces[i].share, e_before, e_said));
        if (f != nullptr && written_.state().inverse_time()) {
          const double part = std::max(pieces[i].share - share_before, kLeastShare);
          words.push_back({'F', plain_number(f->value / part, kFeedDigits)});
        }
      }
      std::string said = i == 0 ? line.with(words) : continued(words, line.in_machine());
      if (i > 0) said += " " + continuation_comment(i + 1, pieces.size(), number);
      written_.read(said, number);
      check(pieces[i], number);
      if (i > 0) out_ += end;
      out_ += said;
      share_before = pieces[i].share;
    }
  }

  std::vector<NewWord> place_words(const MovedPiece& piece, const PlacedLine& line) const {
    const GcodeState& state = written_.state();
    const PlaceReading reading = state.reading_at(piece.X_WT, piece.rotary, line.in_machine());
    std::vector<NewWord> words;
    for (int i = 0; i < 3; ++i) words.push_back({"XYZ"[i], plain_number(reading.xyz[i], kLengthDigits)});
    const std::string& rotary = written_.letters().rotary;
    if (piece.rotary) {
      for (std::size_t i = 0; i < rotary.size(); ++i)
        words.push_back({rotary[i], plain_number(i == 0 ? reading.turns.b : reading.turns.c, kLengthDigits)});
      return words;
    }
    const Mat3 R_WT = piece.X_WT.linear();
    if (!line.states_orientation() && angle_between(state.X_WT().linear(), R_WT) < kSameTurn) return words;
    // Where W turns an axis, the tool's axis is all that can be said.
    const bool quaternion = rotary.find('W') == std::string::npos;
    Quat q(R_WT);
    if (q.w() < 0) q.coeffs() *= -1;
    if (quaternion) words.push_back({'W', plain_number(q.w(), kOrientationDigits)});
    const Vec3 said = quaternion ? Vec3(q.vec()) : tool_axis(piece.X_WT);
    for (int i = 0; i < 3; ++i) words.push_back({"IJK"[i], plain_number(said[i], kOrientationDigits)});
    return words;
  }

  NewWord filament(const Word& e, double share, double before, double& said) const {
    if (share == 1 && !written_.state().relative_extrusion())
      return {e.letter, plain_number(e.value, kLengthDigits)};
    if (!written_.state().relative_extrusion())
      return {e.letter, plain_number(before + share * (e.value - before), kLengthDigits)};
    const NewWord word{e.letter, plain_number(share * e.value - said, kLengthDigits)};
    said += std::stod(word.number);
    return word;
  }

  /// Of a piece after the first, whose command is modal.
  static std::string continued(const std::vector<NewWord>& words, bool in_machine) {
    std::string text = in_machine ? "G53" : "";
    for (const NewWord& word : words) text += (text.empty() ? "" : " ") + text_of(word);
    return text;
  }

  /// What the reader makes of the line that was just written.
  void check(const MovedPiece& piece, int number) const {
    const Pose& X_WT = written_.state().X_WT();
    const double off = (X_WT.translation() - piece.X_WT.translation()).norm();
    if (off > kSamePlace)
      throw InputError(Place{file_, number},
                       fmt::format("the words of this line cannot say where the tool is to go: {:.6f} mm off",
                                   to_mm(off)));
  }

  const std::string& file_;
  const MovedLines& moved_;
  std::vector<Step> steps_;
  GcodeLineReader original_, written_;
  std::string out_;
};

constexpr std::string_view kOrigin = "; compensated from ", kOriginDigest = ", sha256 ";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// Calls visit(line, number, line end) for every line of a text.
template <typename Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  int number = 1;
  for (std::string_view rest = text; !rest.empty(); ++number) {
    const std::string_view before = rest;
    const std::string_view line = take_line(rest);
    visit(line, number, before.substr(line.size(), before.size() - rest.size() - line.size()));
  }
}

}  // namespace

std::vector<int> lines_that_place(const std::string& text, const std::string& file,
                                  const GcodeOptions& options) {
  std::vector<Step> steps;
  std::vector<int> lines;
  GcodeLineReader reader(file, options, steps);
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  for_each_line(rest, [&](std::string_view line, int number, std::string_view) {
    reader.read(line, number);
    if (reader.said_place()) lines.push_back(number);
    steps.clear();
  });
  reader.finish();
  return lines;
}

std::string rewrite_gcode(const std::string& text, const std::string& file, const GcodeOptions& options,
                          const MovedLines& moved) {
  Rewriter rewriter(file, options, moved);
  std::string_view rest = text;
  const bool marked = rest.starts_with(kByteOrderMark);
  if (marked) rest.remove_prefix(kByteOrderMark.size());
  for_each_line(rest, [&](std::string_view line, int number, std::string_view end) {
    rewriter.add(line, number, end);
  });
  return (marked ? std::string(kByteOrderMark) : "") + rewriter.finish();
}

std::string continuation_comment(std::size_t piece, std::size_t pieces, int line) {
  return fmt::format("; {}/{} of line {}", piece, pieces, line);
}

std::string origin_comment(const ProgramOrigin& origin) {
  return fmt::format("{}{}{}{}", kOrigin, origin.file, kOriginDigest, origin.sha256);
}

std::optional<ProgramOrigin> origin_of(std::string_view text) {
  while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
  const auto begin = text.find_last_of("\r\n");
  std::string_view line = begin == std::string_view::npos ? text : text.substr(begin + 1);
  if (!line.starts_with(kOrigin)) return std::nullopt;
  line.remove_prefix(kOrigin.size());
  const auto digest = line.rfind(kOriginDigest);
  if (digest == std::string_view::npos) return std::nullopt;
  return ProgramOrigin{std::string(line.substr(0, digest)),
                       std::string(line.substr(digest + kOriginDigest.size()))};
}

bool is_continuation(std::string_view line) {
  static const std::regex pattern("; [0-9]+/[0-9]+ of line [0-9]+[ \t]*$");
  const auto comment = line.rfind("; ");
  return comment != std::string_view::npos &&
         std::regex_match(line.begin() + static_cast<std::ptrdiff_t>(comment), line.end(), pattern);
}

}  // namespace understudy::toolpath
