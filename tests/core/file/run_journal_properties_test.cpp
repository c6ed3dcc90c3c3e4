// Random operations on a journal and on a list of its lines.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <rapidcheck/state.h>

#include "core/file/run_journal.h"
#include "tests/property.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {

using Answer = RunJournal::Answer;

constexpr std::size_t kItems = 5;

struct Model {
  std::vector<std::pair<std::size_t, Answer>> lines;  ///< as they stand in the file

  std::map<std::size_t, Answer> answers() const {
    std::map<std::size_t, Answer> last;
    for (const auto& [item, answer] : lines) last[item] = answer;
    return last;
  }
  void open_again() {
    const auto last = answers();
    lines.assign(last.begin(), last.end());
  }
};

struct Files {
  TemporaryFolder folder;
  std::string study = "sweep 1";
  std::optional<RunJournal> journal;

  std::filesystem::path path() const { return folder / "journal"; }
  void open() { journal.emplace(path(), study); }
};

bool same(const Answer& a, const Answer& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
  return true;
}

Answer drawn_answer() {
  Answer answer;
  for (int n = *property::whole(0, 3); n > 0; --n)
    answer.push_back(*rc::gen::oneOf(property::real(-1, 1), property::magnitude(1e-300, 1e300),
                                     rc::gen::element(std::nan(""), HUGE_VAL, -HUGE_VAL, -0.0, 5e-324)));
  return answer;
}

struct Command : rc::state::Command<Model, Files> {
  void run(const Model& model, Files& files) const final {
    act(model, files);
    const auto expected = nextState(model).answers();
    for (std::size_t item = 0; item < kItems; ++item) {
      const auto found = files.journal->find(item);
      const auto known = expected.find(item);
      RC_ASSERT(found.has_value() == (known != expected.end()));
      if (found) RC_ASSERT(same(*found, known->second));
    }
  }
  virtual void act(const Model& model, Files& files) const = 0;
};

struct Add : Command {
  std::size_t item = static_cast<std::size_t>(*property::whole(0, kItems - 1));
  Answer answer = drawn_answer();
  void apply(Model& model) const override { model.lines.emplace_back(item, answer); }
  void act(const Model& /*model*/, Files& files) const override { files.journal->add(item, answer); }
  void show(std::ostream& out) const override {
    out << fmt::format("add {}: {}", item, fmt::join(answer, " "));
  }
};

/// The process died, and another goes on.
struct Kill : Command {
  void apply(Model& model) const override { model.open_again(); }
  void act(const Model& /*model*/, Files& files) const override { files.open(); }
  void show(std::ostream& out) const override { out << "kill"; }
};

/// It died in the middle of its last line.
struct KillWhileWriting : Command {
  double share = *property::real(0, 1);  ///< of the line that was written
  void checkPreconditions(const Model& model) const override { RC_PRE(!model.lines.empty()); }
  void apply(Model& model) const override {
    model.lines.pop_back();
    model.open_again();
  }
  void act(const Model& /*model*/, Files& files) const override {
    files.journal.reset();
    std::ifstream in(files.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t begin = text.rfind('\n', text.size() - 2) + 1;
    const auto kept = static_cast<std::size_t>(share * static_cast<double>(text.size() - 1 - begin));
    std::filesystem::resize_file(files.path(), begin + kept);
    files.open();
  }
  void show(std::ostream& out) const override { out << "kill after " << share << " of the last line"; }
};

struct Confirm : Command {
  bool changed = *property::whole(0, 2) == 0;
  Answer other = drawn_answer();

  Answer answer(const Model& model) const {
    const auto answers = model.answers();
    const auto found = answers.find(0);
    return changed || found == answers.end() ? other : found->second;
  }
  bool stands(const Model& model) const {
    const auto answers = model.answers();
    const auto found = answers.find(0);
    return found != answers.end() && same(found->second, answer(model));
  }
  void checkPreconditions(const Model& model) const override {
    // -0 and 0, two signs of NaN: alike as numbers, not as text.
    for (const double v : answer(model)) RC_PRE(!(v == 0 || std::isnan(v)));
  }
  void apply(Model& model) const override {
    if (!stands(model)) model.lines = {{0, answer(model)}};
  }
  void act(const Model& model, Files& files) const override {
    RC_ASSERT(files.journal->confirm(answer(model)) == stands(model));
  }
  void show(std::ostream& out) const override { out << "confirm" << (changed ? " another answer" : ""); }
};

struct OtherStudy : Command {
  void apply(Model& model) const override { model.lines.clear(); }
  void act(const Model& /*model*/, Files& files) const override {
    files.study += "1";
    files.open();
  }
  void show(std::ostream& out) const override { out << "another study"; }
};

TEST(RunJournalProperties, EveryAnswerThatWasWrittenWholeStandsAndNoOther) {
  property::check({40, 30}, [] {
    Files files;
    files.open();
    rc::state::check(
        Model{}, files,
        rc::state::gen::execOneOfWithArgs<Add, Add, Add, Kill, KillWhileWriting, Confirm, OtherStudy>());
  });
}

}  // namespace
}  // namespace understudy
