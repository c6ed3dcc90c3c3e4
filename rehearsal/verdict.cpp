#include "rehearsal/verdict.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace understudy::rehearsal {
namespace {

std::string with_place(const Finding& finding) {
  std::string text = finding.message;
  if (!text.empty() && text.back() == '.') text.pop_back();
  if (finding.gcode_line > 0) text += fmt::format(" (line {})", finding.gcode_line);
  return text;
}

// 100.0 % means all of it. The small part makes up for a decimal fraction that binary cannot hold.
double percent_rounded_down(double fraction) { return std::floor(1000 * fraction + 1e-6) / 10; }

std::string no_go_sentence(const Record& record) {
  const auto is_error = [](const Finding& f) { return f.severity == Severity::error; };
  const auto first = std::find_if(record.findings.begin(), record.findings.end(), is_error);
  const auto errors = std::count_if(record.findings.begin(), record.findings.end(), is_error);
  if (first == record.findings.end()) return "The rehearsal did not reach a go, and no finding says why.";
  std::string text = with_place(*first);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (errors > 1) text += fmt::format(", and {} more error{}", errors - 1, errors > 2 ? "s" : "");
  if (!record.print) text += "; the program was not run";
  return text + ".";
}

std::string go_sentence(const Record& record) {
  std::vector<std::string> clauses;
  if (record.gap)
    clauses.push_back(fmt::format("the gap starts at {:.3f} mm and is in the band over {:.1f} % of the path",
                                  record.gap->start_mm, percent_rounded_down(record.gap->in_band_fraction)));
  if (record.collision && record.collision->min_clearance_mm)
    clauses.push_back(fmt::format("nothing but the nozzle comes nearer than {:.2f} mm to anything",
                                  *record.collision->min_clearance_mm));
  if (record.accuracy)
    clauses.push_back(fmt::format("the tip errs by at most {:.0f} um", record.accuracy->tip_max_um));
  if (clauses.empty()) return "No limit is broken.";
  std::string text = "No limit is broken: ";
  for (std::size_t i = 0; i < clauses.size(); ++i)
    text += (i == 0 ? "" : i + 1 == clauses.size() ? " and " : ", ") + clauses[i];
  return text + ".";
}

}  // namespace

std::string verdict_sentence(const Record& record) {
  return record.go ? go_sentence(record) : no_go_sentence(record);
}

}  // namespace understudy::rehearsal
