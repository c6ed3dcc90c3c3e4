#include "toolpath/robot/rapid_reader.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/digest.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kDeepestCall = 20;                   // docs/limits.md
constexpr std::size_t kMostStatementsOfCalls = 1'000'000;  // docs/limits.md

struct BlockWords {
  std::string_view begin, end;
};
constexpr BlockWords kBlocks[] = {
    {"IF", "ENDIF"}, {"FOR", "ENDFOR"}, {"WHILE", "ENDWHILE"}, {"TEST", "ENDTEST"}, {"RECORD", "ENDRECORD"}};

/// The name of PROC NAME(...), and whether it takes parameters.
std::pair<std::string, bool> routine_head(std::string_view text, const Place& place) {
  StatementScanner scanner(text, place);
  std::string name = scanner.name();
  if (name == "LOCAL") name = scanner.name();
  name = scanner.name();
  scanner.take('(');
  return {name, scanner.peek() != ')'};
}

}  // namespace

RapidReader::RapidReader(const std::string& text, const std::string& file, const RobotOptions& options)
    : file_(file),
      text_(text),
      options_(options),
      statements_(rapid_statements(text_, file)),
      path_(file, options.chords_max) {
  path_.facts.language = RobotLanguage::rapid;
  variables_.present = [this] { return rapid_target(path_.X_UN().value_or(Pose::Identity())); };
  const RapidValue frame = rapid_target(Pose::Identity());
  variables_.set(
      "WOBJ0",
      RapidValue::list({RapidValue::of(0), RapidValue::of(1), RapidValue::of_name(""), frame, frame}),
      Place{file_});
  find_routines();
}

void RapidReader::find_routines() {
  std::string open;
  for (std::size_t i = 0; i < statements_.size(); ++i) {
    const RapidStatement& statement = statements_[i];
    const bool begins = statement.word == "PROC" || statement.word == "FUNC" || statement.word == "TRAP";
    const bool ends =
        statement.word == "ENDPROC" || statement.word == "ENDFUNC" || statement.word == "ENDTRAP";
    if (begins) {
      if (!open.empty())
        throw InputError(Place{file_, statement.line}, fmt::format("the routine {} has no end", open));
      const auto [name, parameters] = routine_head(statement.text, {file_, statement.line});
      if (name.empty()) throw InputError(Place{file_, statement.line}, "a routine without a name");
      open = name;
      routines_.insert_or_assign(name,
                                 Routine{i + 1, statements_.size(), parameters || statement.word != "PROC"});
    } else if (ends && !open.empty()) {
      routines_[open].last = i;
      open.clear();
    }
  }
  if (!open.empty()) throw InputError(Place{file_}, fmt::format("the routine {} has no end", open));
  if (routines_.empty())
    throw InputError(Place{file_}, statements_.empty() ? "empty file, a program in RAPID has a PROC"
                                                       : "no PROC: a program in RAPID has one");
}

/// main, or the only one that takes no parameters.
std::string RapidReader::main_routine() const {
  if (routines_.contains("MAIN")) return "MAIN";
  std::vector<std::string> names;
  for (const auto& [name, routine] : routines_)
    if (!routine.takes_parameters) names.push_back(name);
  if (names.size() == 1) return names.front();
  std::sort(names.begin(), names.end());
  constexpr std::size_t kShown = 10;
  const bool more = names.size() > kShown;
  names.resize(std::min(names.size(), kShown));
  throw InputError(
      Place{file_},
      fmt::format("which routine is to run cannot be told: none is called main; there "
                  "are {}{}",
                  names.empty() ? "none without parameters" : fmt::format("{}", fmt::join(names, ", ")),
                  more ? " and more" : ""));
}

Program RapidReader::read() {
  // Data of the module; nothing else stands outside of routines.
  constexpr std::string_view kOutside[] = {"MODULE",  "ENDMODULE", "ENDPROC", "ENDFUNC",
                                           "ENDTRAP", "ENDRECORD", "VAR",     "PERS",
                                           "CONST",   "LOCAL",     "TASK"};
  bool inside = false;
  for (std::size_t i = 0; i < statements_.size(); ++i) {
    const std::string& word = statements_[i].word;
    if (word == "PROC" || word == "FUNC" || word == "TRAP" || word == "RECORD") inside = true;
    const std::string_view* known = std::find(std::begin(kOutside), std::end(kOutside), word);
    if (!inside && known == std::end(kOutside))
      throw InputError(Place{file_, statements_[i].line},
                       fmt::format("'{}' stands outside of a routine", statements_[i].text.substr(0, 40)));
    if (word.starts_with("END"))
      inside = inside && word != "ENDPROC" && word != "ENDFUNC" && word != "ENDTRAP" && word != "ENDRECORD";
    else if (!inside && word != "MODULE")
      run_statement(i);
  }
  run(routines_.at(main_routine()));
  path_.end();
  if (options_.unknown != nullptr) *options_.unknown = unknown_.counts();
  if (options_.unknown == nullptr || !path_.has_moves()) unknown_.fail_if_any();
  return resolve(path_, options_);
}

void RapidReader::run(const Routine& routine) {
  for (std::size_t i = routine.first; i < routine.last && !returned_ && !exited_;) {
    // A handler of errors, at the end of a routine, is never run.
    if (statements_[i].word == "ERROR" || statements_[i].word == "UNDO") break;
    i = run_statement(i);
  }
  returned_ = false;
}

bool RapidReader::is_ignored(const std::string& word) const {
  return std::find(options_.ignored.begin(), options_.ignored.end(), upper_case(word)) !=
         options_.ignored.end();
}

void RapidReader::count_statement(int line) {
  if (++statements_run_ > statements_.size() + kMostStatementsOfCalls)
    throw InputError(Place{file_, line},
                     fmt::format("calls run more than {} statements", kMostStatementsOfCalls));
}

/// The index of the statement to run next.
std::size_t RapidReader::run_statement(std::size_t index) {
  const RapidStatement& statement = statements_[index];
  count_statement(statement.line);
  path_.set_line(statement.line);
  if (std::any_of(std::begin(kBlocks), std::end(kBlocks),
                  [&](const BlockWords& block) { return block.begin == statement.word; }))
    return pass_block(index);
  StatementScanner scanner(statement.text, {file_, statement.line});
  try {
    if (scanner.name().empty()) scanner.fail("an instruction");
    if (!is_ignored(statement.word)) run_instruction(statement.word, scanner);
  } catch (const UnknownStatement& error) {
    if (!is_ignored(error.word())) unknown_.add(error);
  } catch (const InputError&) {
    if (options_.unknown == nullptr) unknown_.fail_if_any();  // this may come of what was not read
    throw;
  }
  return index + 1;
}

/// Loops and branches are told by name, and passed over to their ends. IF without THEN is one statement.
std::size_t RapidReader::pass_block(std::size_t index) {
  const RapidStatement& statement = statements_[index];
  const BlockWords& block = *std::find_if(std::begin(kBlocks), std::end(kBlocks),
                                          [&](const BlockWords& b) { return b.begin == statement.word; });
  const auto is_compact = [](const RapidStatement& s) {
    return s.word == "IF" && (s.text.size() < 4 || upper_case(s.text.substr(s.text.size() - 4)) != "THEN");
  };
  if (!is_ignored(statement.word)) unknown_.add(UnknownStatement({file_, statement.line}, statement.word));
  if (is_compact(statement)) return index + 1;
  std::size_t end = index + 1;
  for (int depth = 1; end < statements_.size(); ++end) {
    count_statement(statements_[end].line);
    if (statements_[end].word == block.begin && !is_compact(statements_[end])) ++depth;
    if (statements_[end].word == block.end && --depth == 0) return end + 1;
  }
  throw InputError(Place{file_, statement.line}, fmt::format("{} has no {}", statement.word, block.end));
}

void RapidReader::call(const std::string& name, Scanner& scanner) {
  const auto routine = routines_.find(name);
  if (routine == routines_.end() || routine->second.takes_parameters)
    throw UnknownStatement(scanner.place(), name);
  if (name == "MAIN" || std::find(calls_.begin(), calls_.end(), name) != calls_.end())
    throw InputError(scanner.place(), fmt::format("{} calls itself", name));
  if (calls_.size() == kDeepestCall)
    throw InputError(scanner.place(),
                     fmt::format("routines call each other more than {} deep", kDeepestCall));
  calls_.push_back(name);
  run(routine->second);
  calls_.pop_back();
}

Program parse_rapid(const std::string& text, const std::string& file, const RobotOptions& options) {
  Program program = RapidReader(text, file, options).read();
  program.sha256 = sha256_hex(text);
  return program;
}

}  // namespace understudy::toolpath
