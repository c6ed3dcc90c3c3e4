#include "report/study/error_budget_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/assert.h"
#include "core/text/stable_number.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using sim::TruthGroup;
using studies::BudgetAnswer;
using studies::ErrorBudget;
using studies::GroupShare;
using studies::QuantityBudget;
using studies::SobolIndex;
using Json = nlohmann::ordered_json;

Json number(double value) { return stable_number(value, "error budget"); }

Json index_value(const SobolIndex& index) {
  return {{"value", number(index.value)}, {"low", number(index.low)}, {"high", number(index.high)}};
}

Json share_value(TruthGroup group, const GroupShare& share, const std::string& as_built) {
  const Remedy remedy = remedy_of(group, as_built);
  return {{"group", to_string(group)},
          {"first", index_value(share.first)},
          {"total", index_value(share.total)},
          {"key", remedy.key},
          {"procedure", remedy.procedure}};
}

Json quantity_value(const QuantityBudget& quantity, const ErrorBudget& budget) {
  const auto words = studies::words(quantity.quantity);
  Json value{{"quantity", words.key}, {"what", words.what}, {"samples", quantity.samples}};
  if (!quantity.why.empty()) value["not_shared_out"] = quantity.why;
  if (quantity.shares.empty()) return value;
  value["mean"] = number(quantity.mean);
  value["sigma"] = number(quantity.sigma);
  value["groups"] = Json::array();
  for (const std::size_t g : by_total(quantity))
    value["groups"].push_back(share_value(budget.plan.groups[g], quantity.shares[g], budget.plan.as_built));
  return value;
}

/// The section of the machine file that the geometry of such machines is drawn from.
Remedy geometry_remedy(const std::string& as_built) {
  if (as_built == "calibrated")
    return {"calibration.covariance_mm_rad", "calibrate again with more or better poses"};
  if (as_built == "sampled")
    return {"tolerances.after_calibration", "calibrate more finely: understudy calibrate"};
  return {"tolerances.manufactured", "calibrate the machine: understudy calibrate"};
}

std::string with_interval(const SobolIndex& index) {
  return fmt::format("{:>5} [{:>5}, {:>5}]", share_text(index.value), share_text(index.low),
                     share_text(index.high));
}

std::string world_name(const ErrorBudget& budget, std::size_t world) {
  if (world < 2) return world == 0 ? "a" : "b";
  return to_string(budget.plan.groups[world - 2]);
}

std::string table_of(const QuantityBudget& quantity, const ErrorBudget& budget) {
  const auto words = studies::words(quantity.quantity);
  std::string table = fmt::format("\n{} ({})\n", words.what, words.key);
  if (quantity.shares.empty()) return table + fmt::format("  not shared out: {}\n", quantity.why);
  const std::string unit = std::string(words.unit) == "1" ? "" : fmt::format(" {}", words.unit);
  table += fmt::format("  mean {:.4g}{}, 1 sigma {:.4g}{}, {} of {} samples\n", quantity.mean, unit,
                       quantity.sigma, unit, quantity.samples, budget.samples);
  table += "  group       first [95 %]           total [95 %]           what changes it\n";
  for (const std::size_t g : by_total(quantity)) {
    const TruthGroup group = budget.plan.groups[g];
    const GroupShare& share = quantity.shares[g];
    const Remedy remedy = remedy_of(group, budget.plan.as_built);
    table += fmt::format("  {:<10}  {}   {}   {}{}\n", to_string(group), with_interval(share.first),
                         with_interval(share.total), remedy.procedure,
                         remedy.key.empty() ? "" : fmt::format(" ({})", remedy.key));
  }
  return table;
}

}  // namespace

Remedy remedy_of(TruthGroup group, const std::string& as_built) {
  switch (group) {
    case TruthGroup::geometry:
      return geometry_remedy(as_built);
    case TruthGroup::lead:
      return {"tolerances.drives.lead_permille", "measure each screw's lead, or fit better screws"};
    case TruthGroup::periodic:
      return {"tolerances.drives.periodic_um", "align couplings and bearings of the screws"};
    case TruthGroup::play:
      return {"tolerances.drives.play_permille", "preload nuts and joints"};
    case TruthGroup::mounting:
      return as_built == "calibrated"
                 ? Remedy{"gap_sensor, else tolerances.mounting",
                          "calibrate laser and microscope with more pictures: understudy calibrate "
                          "gap-sensor"}
                 : Remedy{"tolerances.mounting",
                          "calibrate laser and microscope: understudy calibrate gap-sensor"};
    case TruthGroup::camera:
      return {"tolerances.optics.camera_centre_px, distortion_k1, blur_permille",
              "calibrate the camera (understudy calibrate gap-sensor), focus it"};
    case TruthGroup::light:
      return {"tolerances.optics.laser_power_permille, waist_permille, ambient_light_permille",
              "steady the laser, shade the part"};
    case TruthGroup::part_place:
      return {"tolerances.part.position_mm, rotation_mrad", "locate the clamped part, better stops"};
    case TruthGroup::part_shape:
      return {"tolerances.part.size_permille, ripple_um", "measure the part, or make it more exactly"};
    case TruthGroup::table:
      return {"tolerances.table", "level the table, or a flatter one"};
    case TruthGroup::process:
      return {"tolerances.process", "measure the filament, calibrate extruder and thermistor"};
    case TruthGroup::noise:
      break;
  }
  UNDERSTUDY_ASSERT(group == TruthGroup::noise, "every group has a remedy");
  return {"", "average more frames of the gap camera"};
}

std::string share_text(double share) {
  const bool rounds_to_zero = std::abs(share) < 0.005;
  return fmt::format("{:.2f}", rounds_to_zero ? 0.0 : share);
}

std::vector<std::size_t> by_total(const QuantityBudget& quantity) {
  std::vector<std::size_t> order(quantity.shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return quantity.shares[a].total.value > quantity.shares[b].total.value;
  });
  return order;
}

std::string budget_cost(const studies::BudgetPlan& plan, int samples) {
  return fmt::format("{} samples x ({} group{} + 2) = {} rehearsals of machines as built {}", samples,
                     plan.groups.size(), plan.groups.size() == 1 ? "" : "s", plan.rehearsals, plan.as_built);
}

std::string budget_json(const ErrorBudget& budget) {
  Json json;
  json["schema"] = "understudy.budget/1";
  json["machine"] = budget.machine;
  json["as_built"] = budget.plan.as_built;
  json["gap_control"] = budget.gap_control;
  json["engine"] = budget.engine;
  json["samples"] = budget.samples;
  json["rehearsals"] = budget.plan.rehearsals;
  json["stopped_early"] = budget.stopped;
  json["interval"] = studies::Bootstrap{}.level;
  json["groups"] = Json::array();
  for (const TruthGroup group : budget.plan.groups) json["groups"].push_back(to_string(group));
  json["quantities"] = Json::array();
  for (const QuantityBudget& quantity : budget.quantities)
    json["quantities"].push_back(quantity_value(quantity, budget));
  json["provenance"] = {{"version", kVersion},
                        {"machine_sha256", budget.machine_sha256},
                        {"program_sha256", budget.program_sha256},
                        {"first_seed", std::to_string(budget.first_seed)},
                        {"command", budget.command}};
  return to_text(json, 2) + "\n";
}

std::string budget_csv(const ErrorBudget& budget) {
  std::string csv = "quantity,group,samples,first,first_low,first_high,total,total_low,total_high\n";
  for (const QuantityBudget& quantity : budget.quantities)
    for (std::size_t g = 0; g < quantity.shares.size(); ++g) {
      const auto& [first, total] = quantity.shares[g];
      csv += fmt::format("{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n",
                         studies::words(quantity.quantity).key, to_string(budget.plan.groups[g]),
                         quantity.samples, first.value, first.low, first.high, total.value, total.low,
                         total.high);
    }
  return csv;
}

std::string budget_runs_csv(const ErrorBudget& budget) {
  std::string csv = "sample,world,stopped";
  for (const QuantityBudget& quantity : budget.quantities)
    csv += fmt::format(",{}", studies::words(quantity.quantity).key);
  csv += "\n";
  for (std::size_t sample = 0; sample < budget.answers.size(); ++sample)
    for (std::size_t world = 0; world < budget.answers[sample].size(); ++world) {
      const BudgetAnswer& answer = budget.answers[sample][world];
      csv += fmt::format("{},{},{:d}", sample, world_name(budget, world), answer.stopped);
      for (const QuantityBudget& quantity : budget.quantities) {
        const auto& value = answer.values[static_cast<std::size_t>(quantity.quantity)];
        csv += value ? fmt::format(",{:.6f}", *value) : ",";
      }
      csv += "\n";
    }
  return csv;
}

std::string budget_table(const ErrorBudget& budget) {
  std::string table = fmt::format(
      "{}\n{} on {}, gap control {}\n{} of {} rehearsals stopped early: in band 0, without a place in the "
      "means along the path\n",
      budget_cost(budget.plan, budget.samples), budget.engine, budget.machine, budget.gap_control,
      budget.stopped, budget.plan.rehearsals);
  for (const QuantityBudget& quantity : budget.quantities) table += table_of(quantity, budget);
  return table;
}

}  // namespace understudy::report
