#include "report/recorded/rehearsal_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/recorded/verification.h"

namespace understudy::report {
namespace {

using regression::MetricChange;
using rehearsal::FindingGroup;
using rehearsal::Severity;

/// Errors come before warnings.
using KindKey = std::pair<bool, std::string>;
using Kinds = std::map<KindKey, KindOfFinding>;

constexpr std::size_t kInputsNamed = 4;

void add(const FindingGroup& group, KindOfFinding& kind) {
  if (kind.count == 0) kind.worst = group.worst.message;
  kind.count += group.count;
  if (group.first_line == 0) return;
  kind.first_line = kind.first_line == 0 ? group.first_line : std::min(kind.first_line, group.first_line);
  kind.last_line = std::max(kind.last_line, group.last_line);
}

Kinds kinds_of(const std::vector<FindingGroup>& groups) {
  Kinds kinds;
  for (const FindingGroup& group : groups)
    add(group, kinds[{group.worst.severity == Severity::warning, group.worst.kind}]);
  return kinds;
}

FindingChange change_of(const KindOfFinding& a, const KindOfFinding& b) {
  if (a.count == 0) return FindingChange::added;
  if (b.count == 0) return FindingChange::gone;
  if (a.count != b.count) return b.count > a.count ? FindingChange::more : FindingChange::fewer;
  if (a.first_line != b.first_line || a.last_line != b.last_line) return FindingChange::moved;
  return a.worst == b.worst ? FindingChange::same : FindingChange::changed;
}

std::vector<ComparedFindings> compare_findings(const RecordedRehearsal& a, const RecordedRehearsal& b) {
  std::map<KindKey, std::pair<KindOfFinding, KindOfFinding>> both;
  for (const auto& [key, kind] : kinds_of(a.findings)) both[key].first = kind;
  for (const auto& [key, kind] : kinds_of(b.findings)) both[key].second = kind;
  std::vector<ComparedFindings> compared;
  for (const auto& [key, kinds] : both)
    compared.push_back({key.second, key.first ? Severity::warning : Severity::error,
                        change_of(kinds.first, kinds.second), kinds.first, kinds.second});
  return compared;
}

std::vector<InputChange> compare_inputs(const RecordedRehearsal& a, const RecordedRehearsal& b) {
  auto names = a.inputs;
  names.insert(b.inputs.begin(), b.inputs.end());
  const auto value = [](const RecordedRehearsal& of, const std::string& name) {
    const auto found = of.inputs.find(name);
    return found == of.inputs.end() ? std::nullopt : std::optional(found->second);
  };
  std::vector<InputChange> changes;
  for (const auto& [name, unused] : names)
    if (value(a, name) != value(b, name)) changes.push_back({name, value(a, name), value(b, name)});
  return changes;
}

/// Names that the contract does not list come last, by name.
std::vector<MetricChange> compare_figures(const RecordedRehearsal& a, const RecordedRehearsal& b) {
  std::vector<MetricChange> changes = regression::changes(a.figures, b.figures);
  const std::vector<std::string>& order = regression::metric_names();
  std::ranges::stable_sort(changes, {}, [&](const MetricChange& change) {
    return std::ranges::find(order, change.metric) - order.begin();
  });
  return changes;
}

std::string compare_curves(const RecordedRehearsal& a, const RecordedRehearsal& b) {
  for (const ResultsDifference& difference : compare_results(a.folder, b.folder))
    if (difference.file == "trace.csv") return difference.details;
  return "";
}

std::size_t same_figures(const RecordedRehearsal& a, const RecordedRehearsal& b) {
  return static_cast<std::size_t>(std::ranges::count_if(a.figures, [&](const auto& figure) {
    const auto found = b.figures.find(figure.first);
    return found != b.figures.end() && found->second == figure.second;
  }));
}

std::string finding_words(const RehearsalComparison& comparison) {
  std::map<FindingChange, std::vector<std::string>> by_change;
  for (const ComparedFindings& findings : comparison.findings)
    by_change[findings.change].push_back(findings.kind);
  by_change.erase(FindingChange::same);
  std::vector<std::string> words;
  for (const auto& [change, kinds] : by_change)
    words.push_back(fmt::format("{} {}", fmt::join(kinds, ", "), word(change)));
  return fmt::format("{}", fmt::join(words, "; "));
}

std::string input_words(const RehearsalComparison& comparison) {
  if (comparison.inputs.empty())
    return comparison.same_inputs ? "all inputs are the same" : "inputs differ in what no record names";
  std::vector<std::string> names;
  for (const InputChange& change : comparison.inputs)
    if (names.size() < kInputsNamed) names.push_back(change.name);
  const std::size_t more = comparison.inputs.size() - names.size();
  return fmt::format("inputs differ in {}{}", fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace

const char* word(FindingChange change) {
  switch (change) {
    case FindingChange::gone:
      return "gone";
    case FindingChange::added:
      return "new";
    case FindingChange::fewer:
      return "fewer";
    case FindingChange::more:
      return "more";
    case FindingChange::moved:
      return "elsewhere";
    case FindingChange::changed:
      return "other value";
    case FindingChange::same:
      break;
  }
  return "same";
}

bool RehearsalComparison::differs() const {
  return !same_verdict || !figures.empty() || !curves.empty() ||
         std::ranges::any_of(findings, [](const auto& each) { return each.change != FindingChange::same; });
}

RehearsalComparison compare_rehearsals(const RecordedRehearsal& a, const RecordedRehearsal& b) {
  RehearsalComparison comparison;
  comparison.inputs = compare_inputs(a, b);
  comparison.same_inputs = a.run.inputs_sha256 == b.run.inputs_sha256;
  comparison.findings = compare_findings(a, b);
  comparison.figures = compare_figures(a, b);
  comparison.figures_same = same_figures(a, b);
  comparison.curves = compare_curves(a, b);
  comparison.same_verdict = a.grade == b.grade;
  return comparison;
}

std::optional<double> difference_of(const MetricChange& change) {
  if (!change.before || !change.after) return std::nullopt;
  const auto* before = std::get_if<double>(&*change.before);
  const auto* after = std::get_if<double>(&*change.after);
  if (!before || !after || !std::isfinite(*after - *before)) return std::nullopt;
  return *after - *before;
}

std::string comparison_sentence(const RehearsalComparison& comparison) {
  if (!comparison.differs()) return "The results are the same; " + input_words(comparison);
  const std::string findings = finding_words(comparison);
  const std::size_t count = comparison.figures.size();
  return fmt::format("{}{} figure{} differ{}; {}", findings.empty() ? "" : "Findings: " + findings + "; ",
                     count, count == 1 ? "" : "s", count == 1 ? "s" : "", input_words(comparison));
}

}  // namespace understudy::report
