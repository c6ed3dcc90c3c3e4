#include "rehearsal/findings/machine_findings.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace understudy::rehearsal {
namespace {

Finding warning(const char* kind, std::size_t count, const std::string& message) {
  Finding finding;
  finding.kind = kind;
  finding.severity = Severity::warning;
  finding.value = static_cast<double>(count);
  finding.message = message;
  return finding;
}

}  // namespace

std::vector<Finding> machine_findings(const machine::MachineNotes& notes) {
  std::vector<Finding> findings;
  if (!notes.assumed.empty()) {
    std::vector<std::string> groups;
    for (const machine::Assumption& assumption : machine::assumptions())
      if (std::ranges::find(notes.assumed, assumption.word) != notes.assumed.end())
        groups.push_back(fmt::format("{} ({})", assumption.word, assumption.bears_on));
    findings.push_back(
        warning("assumption", groups.size(),
                fmt::format("nobody measured these figures of the machine: {}", fmt::join(groups, "; "))));
  }
  if (!notes.unchecked_links.empty())
    findings.push_back(
        warning("unchecked", notes.unchecked_links.size(),
                fmt::format("not checked against collisions, for the machine's file leaves out their shapes, "
                            "or their meshes are not there (geometry.packages): {}",
                            fmt::join(notes.unchecked_links, ", "))));
  return findings;
}

}  // namespace understudy::rehearsal
