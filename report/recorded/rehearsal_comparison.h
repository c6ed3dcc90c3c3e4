// What differs between two rehearsals: inputs, verdict, findings, figures, curves.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "regression/scenario_outcome.h"
#include "report/recorded/recorded_rehearsal.h"

namespace understudy::report {

/// An input that one of the two has not, or that they have otherwise.
struct InputChange {
  std::string name;
  std::optional<std::string> a, b;
};

/// Findings of one kind and severity in one result.
struct KindOfFinding {
  int count = 0;                      ///< 0: none
  int first_line = 0, last_line = 0;  ///< of the program; 0: no line
  std::string worst;                  ///< message of the first group, which speaks for all
};

enum class FindingChange { gone, added, fewer, more, moved, changed, same };  ///< from A to B
const char* word(
    FindingChange change);  ///< "gone", "new", "fewer", "more", "elsewhere", "other value", "same"

struct ComparedFindings {
  std::string kind;
  rehearsal::Severity severity = rehearsal::Severity::error;
  FindingChange change = FindingChange::same;
  KindOfFinding a, b;
};

struct RehearsalComparison {
  std::vector<InputChange> inputs;                ///< that differ
  bool same_inputs = false;                       ///< by the one sum over all of them
  std::vector<ComparedFindings> findings;         ///< errors first, then by name
  std::vector<regression::MetricChange> figures;  ///< that differ, in the order of the summary
  std::size_t figures_same = 0;
  std::string curves;  ///< where trace.csv begins to differ, or which of them lacks it; empty: the same
  bool same_verdict = false;

  /// Of the results: inputs alone are none.
  bool differs() const;
};

RehearsalComparison compare_rehearsals(const RecordedRehearsal& a, const RecordedRehearsal& b);

/// B - A of a figure that both have as a number.
std::optional<double> difference_of(const regression::MetricChange& change);

/// In a sentence without a full stop: what is new, gone and differs, and in which inputs.
std::string comparison_sentence(const RehearsalComparison& comparison);

}  // namespace understudy::report
