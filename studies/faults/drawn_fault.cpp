#include "studies/faults/drawn_fault.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/assert.h"
#include "rehearsal/request/fault_words.h"
#include "sim/faults/faults.h"
#include "studies/gap/injected_fault.h"

namespace understudy::studies {
namespace {

using control::GapStop;

/// A number of three digits in its shortest words, without an exponent.
std::string words_of(double value) { return fmt::format("{:.6g}", value); }

/// Evenly by order of magnitude, to three digits: the command shows all of it.
double draw_size(double low, double high, Random& random) {
  const double value = std::exp(random.uniform(std::log(low), std::log(high)));
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::round(value / digit) * digit;
}

double draw_signed(double low, double high, Random& random) {
  const double sign = random.uniform() < 0.5 ? -1 : 1;
  return sign * draw_size(low, high, random);
}

/// As the table of the gap benchmark has it; of a fault that it leaves out, what lost steps are named by.
std::vector<GapStop> named_by(const std::string& word) {
  const std::vector<GapStop>* moved = nullptr;
  for (const FaultType& type : fault_types()) {
    if (type.machine && to_string(*type.machine) == word) return type.right;
    if (type.camera && to_string(*type.camera) == word) return type.right;
    if (type.machine == sim::FaultKind::lost_steps) moved = &type.right;
  }
  UNDERSTUDY_ASSERT(moved, "the table has lost steps");
  return *moved;
}

/// The axes that may have it.
std::vector<int> axes_of(const machine::MachineDescription& machine, const std::string& word) {
  std::vector<int> axes;
  const int count = machine.make_mechanism()->axis_count();
  for (int i = 0; i < count; ++i) {
    const machine::Drive& drive = machine.drives[static_cast<std::size_t>(i)];
    const bool driven = drive.steps_per_turn > 0;
    if (word == to_string(sim::FaultKind::loose_joint) && !machine.has_play(i)) continue;
    if (word == to_string(sim::FaultKind::disconnected) && !drive.self_locking) continue;
    if (word != to_string(sim::FaultKind::thermal_growth) && !driven) continue;
    axes.push_back(i);
  }
  return axes;
}

bool holds_without_power(const machine::MachineDescription& machine) {
  const int count = machine.make_mechanism()->axis_count();
  for (int i = 0; i < count; ++i)
    if (!machine.drives[static_cast<std::size_t>(i)].self_locking) return false;
  return true;
}

std::string machine_fault(const std::string& word, const machine::MachineDescription& machine,
                          Random& random) {
  using sim::FaultKind;
  if (word == to_string(FaultKind::power_cut)) return "";
  const auto mechanism = machine.make_mechanism();
  const std::vector<int> axes = axes_of(machine, word);
  const auto chosen = std::min(axes.size() - 1,
                               static_cast<std::size_t>(random.uniform(0, static_cast<double>(axes.size()))));
  std::string words = fmt::format(", axis: {}", mechanism->axis_name(axes[chosen]));
  const bool angle = mechanism->axis_is_angle(axes[chosen]);
  const char* const unit = angle ? "arcmin" : "um";
  if (word == to_string(FaultKind::lost_steps))
    return words + fmt::format(", steps: {}", sim::kElectricalCycle *
                                                  static_cast<int>(std::round(draw_size(1, 100, random))));
  if (word == to_string(FaultKind::stall))
    return words + fmt::format(", for_s: {}", words_of(draw_size(0.005, 5, random)));
  const double amount = angle ? draw_signed(0.05, 60, random) : draw_signed(1, 2000, random);
  if (word == to_string(FaultKind::loose_joint))
    return words + fmt::format(", play_{}: {}", unit, words_of(std::abs(amount)));
  if (word == to_string(FaultKind::thermal_growth)) {
    const double over = random.uniform() < 0.3 ? 0 : draw_size(0.01, 20, random);
    return words + fmt::format(", over_s: {}, growth_{}: {}", words_of(over), unit, words_of(amount));
  }
  return words;
}

std::string camera_fault(const std::string& word, Random& random) {
  using sim::CameraFaultKind;
  std::string words;
  const auto add = [&](const char* key, double value) {
    words += fmt::format(", {}: {}", key, words_of(value));
  };
  if (random.uniform() < 0.5) add("share", draw_size(0.01, 1, random));
  if (word == to_string(CameraFaultKind::dim)) add("power", draw_size(0.001, 0.99, random));
  if (word == to_string(CameraFaultKind::saturated)) add("power", draw_size(1.01, 100, random));
  if (word == to_string(CameraFaultKind::ghost)) add("gap_offset_um", draw_signed(1, 5000, random));
  if (word == to_string(CameraFaultKind::displaced))
    add("offset_px", std::round(draw_signed(1, 1000, random)));
  if (word == to_string(CameraFaultKind::cut_beam) || word == to_string(CameraFaultKind::strip)) {
    add("offset_px", draw_signed(0.1, 1000, random));
    add("direction_deg", std::round(random.uniform(-180, 180)));
  }
  return words;
}

}  // namespace

const std::vector<DrawnFaultKind>& drawn_fault_kinds() {
  static const std::vector<DrawnFaultKind> kinds = [] {
    std::vector<DrawnFaultKind> all{{"none", false, false, {}}};
    for (const std::string& word : rehearsal::machine_fault_words())
      all.push_back({word, false, true, named_by(word)});
    for (const std::string& word : rehearsal::camera_fault_words())
      all.push_back({word, true, false, named_by(word)});
    return all;
  }();
  return kinds;
}

bool can_have(const machine::MachineDescription& machine, const DrawnFaultKind& kind) {
  if (kind.of_camera) return machine.has_microscope;
  if (!kind.of_machine) return true;
  if (kind.word == to_string(sim::FaultKind::power_cut)) return holds_without_power(machine);
  return !axes_of(machine, kind.word).empty();
}

std::string draw_fault_words(const DrawnFaultKind& kind, double end,
                             const machine::MachineDescription& machine, Random& random) {
  if (!kind.of_camera && !kind.of_machine) return "";
  const double time = std::round(1e3 * random.uniform(0, end)) / 1e3;
  return fmt::format(
      "{{fault: {}, at_s: {}{}}}", kind.word, time,
      kind.of_camera ? camera_fault(kind.word, random) : machine_fault(kind.word, machine, random));
}

}  // namespace understudy::studies
