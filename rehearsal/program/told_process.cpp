#include "rehearsal/program/told_process.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/quantile.h"
#include "core/text/lower_case.h"
#include "core/units.h"
#include "rehearsal/program/programmed_areas.h"

namespace understudy::rehearsal {
namespace {

constexpr double kSameNozzle = 0.05;   // of the bore; sizes differ by a quarter
constexpr double kSameLayer = 0.3;     // of its height, which lines side by side make uneven
constexpr double kSameFilament = 0.1;  // of its diameter; slicers state what was measured
constexpr double kSameFlow = 0.15;     // of the told section: firmwares' flow is set that finely
constexpr double kThickest = 10;       // [mm], of layers that comments tell

Finding warning(double value, double limit, std::string message, const char* about) {
  return {"program", Severity::warning, 0, 0, value, limit, "mm", std::move(message), 0, about};
}

}  // namespace

std::optional<double> fact_number(const std::map<std::string, std::string>& facts, const std::string& key) {
  const auto found = facts.find(key);
  if (found == facts.end()) return std::nullopt;
  double value = 0;
  const std::string& text = found->second;
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc() &&
                 std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

void mount_nozzle(machine::Tool& tool, double bore) {
  tool.flat_diameter += bore - tool.nozzle_diameter;
  tool.nozzle_diameter = bore;
}

double told_layer(const DialectRequest& dialect, const std::map<std::string, std::string>& facts) {
  if (dialect.layer_mm) return from_mm(*dialect.layer_mm);
  const auto said = fact_number(facts, "layer_height");
  return said && *said > 0 && *said < kThickest ? from_mm(*said) : 0;
}

std::optional<Finding> other_flow(const toolpath::Program& program,
                                  const machine::MachineDescription& machine,
                                  const toolpath::ToldBeads& beads) {
  if (beads.empty() || !machine.tool.prints()) return std::nullopt;
  const std::vector<float> areas = programmed_areas(program, machine);
  std::vector<double> shares;  // of the told section
  int first_line = 0;
  for (std::size_t line = 0; line < areas.size(); ++line) {
    const double told = beads.at(static_cast<int>(line)).area();
    if (told <= 0 || areas[line] <= 0) continue;
    shares.push_back(static_cast<double>(areas[line]) / told);
    if (first_line == 0 && std::abs(shares.back() - 1) > kSameFlow) first_line = static_cast<int>(line);
  }
  if (shares.empty()) return std::nullopt;
  const double share = quantile(shares, 0.5);
  if (std::abs(share - 1) <= kSameFlow) return std::nullopt;
  return Finding{"program",
                 Severity::warning,
                 first_line,
                 0,
                 100 * share,
                 100,
                 "%",
                 fmt::format("fed is {:.0f} % of the filament of the beads that the comments tell, as from "
                             "line {} on: another flow, or another filament?",
                             100 * share, first_line),
                 0,
                 kOtherFlow};
}

std::optional<double> other_filament(const machine::Tool& tool,
                                     const std::map<std::string, std::string>& facts) {
  const double filament = to_mm(tool.filament_diameter);
  const auto said = fact_number(facts, "filament_diameter");
  const bool other =
      tool.prints() && said && *said > 0 && std::abs(*said - filament) > kSameFilament * filament;
  return other ? said : std::nullopt;
}

std::string told_material(const std::map<std::string, std::string>& facts) {
  const auto said = facts.find("material");
  if (said == facts.end()) return "";
  const std::string first = said->second.substr(0, said->second.find_first_of(";, \t"));
  std::string name = lower_case(first);
  std::erase_if(name, [](char c) { return c == '"' || c == '+'; });
  return name;
}

std::optional<Finding> other_material(const std::string& material,
                                      const std::map<std::string, std::string>& facts) {
  const std::string told = told_material(facts);
  if (told.empty() || told == material) return std::nullopt;
  return Finding{"program", Severity::warning,
                 0,         0,
                 0,         0,
                 "",        fmt::format("sliced for {}, judged as {}", facts.at("material"), material),
                 0,         kOtherMaterial};
}

std::vector<Finding> process_warnings(const DialectRequest& dialect, const machine::Tool& tool,
                                      const std::map<std::string, std::string>& facts, double typical_layer) {
  std::vector<Finding> findings;
  const double bore = to_mm(tool.nozzle_diameter);
  const auto sliced = fact_number(facts, "nozzle_diameter");
  if (tool.prints() && sliced && *sliced > 0 && std::abs(*sliced - bore) > kSameNozzle * bore)
    findings.push_back(
        warning(*sliced, bore,
                fmt::format("sliced for a nozzle of {:g} mm, rehearsed with one of {:g} mm", *sliced, bore),
                kOtherNozzle));
  if (const auto sliced_for = other_filament(tool, facts)) {
    const double filament = to_mm(tool.filament_diameter);
    findings.push_back(warning(
        *sliced_for, filament,
        fmt::format("sliced for filament of {:g} mm, rehearsed with one of {:g} mm", *sliced_for, filament),
        kOtherFilament));
  }
  const double layer = to_mm(typical_layer);
  if (dialect.layer_mm && layer > 0 && std::abs(layer - *dialect.layer_mm) > kSameLayer * *dialect.layer_mm)
    findings.push_back(warning(layer, *dialect.layer_mm,
                               fmt::format("most of the path lies {:.3f} mm over what is below, not {:g} mm",
                                           layer, *dialect.layer_mm),
                               kOtherLayer));
  return findings;
}

}  // namespace understudy::rehearsal
