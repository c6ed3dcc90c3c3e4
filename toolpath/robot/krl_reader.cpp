#include "toolpath/robot/krl_reader.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/text/trimmed.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kLineMax = 65'536;              // [bytes]; docs/limits.md
constexpr std::size_t kDeepestCall = 20;              // docs/limits.md
constexpr std::size_t kMostLinesOfCalls = 1'000'000;  // docs/limits.md

struct BlockWords {
  std::string_view begin, end;
};
constexpr BlockWords kBlocks[] = {{"FOR", "ENDFOR"},   {"WHILE", "ENDWHILE"}, {"LOOP", "ENDLOOP"},
                                  {"REPEAT", "UNTIL"}, {"IF", "ENDIF"},       {"SWITCH", "ENDSWITCH"}};

/// Without its comment and the blanks about it.
std::string_view statement_of(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == ';' && !quoted) {
      line = line.substr(0, i);
      break;
    }
  }
  return trimmed(line);
}

std::vector<std::string_view> statements_of(std::string_view text, const std::string& file) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark of some editors
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const Place place{file, static_cast<int>(lines.size()) + 1};
    if (line.size() > kLineMax)
      throw InputError(place, fmt::format("the line has {} bytes, more than {}", line.size(), kLineMax));
    for (const char c : line)
      if (static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\r')
        throw InputError(place, fmt::format("byte {} belongs to no program", static_cast<int>(c)));
    lines.push_back(statement_of(line));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string first_word(std::string_view statement) { return StatementScanner(statement, {}).name(); }

/// "DEF NAME( )" behind DEF; names may have a point.
std::string routine_name(std::string_view rest) {
  const std::size_t end = std::min(rest.find_first_of("( \t"), rest.size());
  return upper_case(rest.substr(0, end));
}

}  // namespace

KrlReader::KrlReader(std::string_view text, const std::string& file, const RobotOptions& options)
    : file_(file), options_(options), lines_(statements_of(text, file)), path_(file, options.chords_max) {
  path_.facts.language = RobotLanguage::krl;
  for (const char* name : {"$NULLFRAME", "$WORLD"}) variables_.set(name, krl_frame(Pose::Identity()));
  find_routines();
}

void KrlReader::find_routines() {
  std::string open;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    StatementScanner scanner(lines_[i], {file_, static_cast<int>(i) + 1});
    std::string word = scanner.name();
    if (word == "GLOBAL") word = scanner.name();
    if (word == "DEF" || word == "DEFFCT") {
      if (!open.empty()) scanner.fail("END of the routine before");
      open = routine_name(scanner.rest());
      if (open.empty()) scanner.fail("the name of a routine");
      const std::string_view rest = scanner.rest();
      const std::size_t bracket = std::min(rest.find('('), rest.size());
      const bool parameters = rest.find_first_not_of("( \t)", bracket) != std::string_view::npos;
      if (main_.empty() && word == "DEF") main_ = open;
      routines_.insert_or_assign(open, Routine{i + 1, lines_.size(), parameters || word == "DEFFCT"});
    } else if ((word == "END" || word == "ENDFCT") && !open.empty()) {
      routines_[open].last = i;
      open.clear();
    }
  }
  if (main_.empty())
    throw InputError(Place{file_}, lines_.empty() ? "empty file, a program in KRL has a DEF"
                                                  : "no DEF: a program in KRL has one");
  if (!open.empty()) throw InputError(Place{file_}, fmt::format("DEF {} has no END", open));
}

Program KrlReader::read() {
  run(routines_.at(main_));
  path_.end();
  if (options_.unknown != nullptr) *options_.unknown = unknown_.counts();
  if (options_.unknown == nullptr || !path_.has_moves()) unknown_.fail_if_any();
  return resolve(path_, options_);
}

void KrlReader::run(const Routine& routine) {
  ended_ = false;
  for (std::size_t i = routine.first; i < routine.last && !ended_;) i = run_line(i);
  ended_ = false;
}

bool KrlReader::is_ignored(const std::string& word) const {
  return std::find(options_.ignored.begin(), options_.ignored.end(), word) != options_.ignored.end();
}

void KrlReader::count_line(int line) {
  if (++lines_run_ > lines_.size() + kMostLinesOfCalls)
    throw InputError(Place{file_, line}, fmt::format("calls run more than {} lines", kMostLinesOfCalls));
}

void KrlReader::check_variables(const Place& place) const {
  if (variables_.bytes() > options_.variables_max)
    throw InputError(
        place, fmt::format("variables up to here need more than {} MB", options_.variables_max / 1'000'000));
}

/// The index of the line to run next.
std::size_t KrlReader::run_line(std::size_t index) {
  const int line = static_cast<int>(index) + 1;
  count_line(line);
  check_variables({file_, line});
  const std::string_view statement = lines_[index];
  if (statement.empty() || statement.front() == '&') return index + 1;
  path_.set_line(line);
  StatementScanner scanner(statement, {file_, line});
  try {
    const std::string word = scanner.name();
    if (std::any_of(std::begin(kBlocks), std::end(kBlocks),
                    [&](const BlockWords& block) { return block.begin == word; }))
      return pass_block(index, word);
    if (word.empty()) scanner.fail("a statement");
    if (!is_ignored(word)) run_statement(word, scanner);
  } catch (const UnknownStatement& error) {
    if (!is_ignored(error.word())) unknown_.add(error);
  } catch (const InputError&) {
    if (options_.unknown == nullptr) unknown_.fail_if_any();  // this may come of a line that was not read
    throw;
  }
  return index + 1;
}

/// Loops and branches are told by name, and passed over to their ends.
std::size_t KrlReader::pass_block(std::size_t index, const std::string& word) {
  const BlockWords& block = *std::find_if(std::begin(kBlocks), std::end(kBlocks),
                                          [&](const BlockWords& b) { return b.begin == word; });
  bool without_effect = word == "FOR";
  std::size_t end = index + 1;
  for (int depth = 1; end < lines_.size(); ++end) {
    count_line(static_cast<int>(end) + 1);
    const std::string first = first_word(lines_[end]);
    if (first == block.begin) ++depth;
    if (first == block.end && --depth == 0) break;
    // FOR I=1 TO 6: $VEL_AXIS[I]=100
    without_effect = without_effect && (first.empty() || first == "$VEL_AXIS" || first == "$ACC_AXIS");
  }
  if (end >= lines_.size())
    throw InputError(Place{file_, static_cast<int>(index) + 1}, fmt::format("{} has no {}", word, block.end));
  if (!without_effect && !is_ignored(word))
    unknown_.add(UnknownStatement({file_, static_cast<int>(index) + 1}, word));
  return end + 1;
}

void KrlReader::call(const std::string& name, Scanner& scanner) {
  scanner.expect('(');
  const auto routine = routines_.find(name);
  if (routine == routines_.end() || routine->second.takes_parameters || !scanner.take(')'))
    throw UnknownStatement(scanner.place(), name);
  if (name == main_ || std::find(calls_.begin(), calls_.end(), name) != calls_.end())
    throw InputError(scanner.place(), fmt::format("{} calls itself", name));
  if (calls_.size() == kDeepestCall)
    throw InputError(scanner.place(),
                     fmt::format("routines call each other more than {} deep", kDeepestCall));
  calls_.push_back(name);
  run(routine->second);
  calls_.pop_back();
}

/// Of the data list; what is none is without effect.
void KrlReader::read_data(std::string_view text) {
  const std::string file = std::filesystem::path(file_).replace_extension(".dat").string();
  const std::vector<std::string_view> lines = statements_of(text, file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    StatementScanner scanner(lines[i], {file, static_cast<int>(i) + 1});
    check_variables(scanner.place());
    try {
      const std::string word = scanner.name();
      if (word.empty() || word == "DEFDAT" || word == "ENDDAT" || word == "EXT" || word == "EXTFCT" ||
          word == "STRUC" || word == "ENUM")
        continue;
      const auto handler = handlers().find(word);
      if (handler != handlers().end() && handler->second == &KrlReader::declare)
        declare(word, scanner);
      else
        assign_or_call(word, scanner);
    } catch (const InputError&) {
      // A name that the program then uses is told there.
    }
  }
}

Program parse_krl(const std::string& text, const std::string& data, const std::string& file,
                  const RobotOptions& options) {
  KrlReader reader(text, file, options);
  reader.read_data(data);
  Program program = reader.read();
  program.sha256 = sha256_hex(data.empty() ? text : text + data);
  return program;
}

}  // namespace understudy::toolpath
