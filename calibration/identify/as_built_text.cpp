// The as-built file of an identified machine: what was not told stands as the machine file has it.
#include <cmath>

#include <fmt/format.h>

#include "calibration/identify/identify.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "machine/file/section_text.h"

namespace understudy::calibration {
namespace {

double found_play(const IdentifiedAxis& axis) {
  return axis.load && axis.load->told(AxisParameter::play) ? axis.load->of(AxisParameter::play)
                                                           : axis.play_before;
}

double found_zero(const IdentifiedAxis& axis) { return axis.load ? axis.load->of(AxisParameter::zero) : 0; }

/// The play in the shares in which the machine file has it.
std::string strut_text(const machine::HexapodModel& hexapod, double offset_before, const IdentifiedAxis& axis,
                       std::size_t i) {
  const double play = found_play(axis);
  const double share = axis.play_before > 0 ? play / axis.play_before : 0;
  const double nut = axis.play_before > 0 ? share * hexapod.play.screw_nut : play;
  return fmt::format(
      "  - {{strut: {}, length_offset_mm: {:.9f}, nut_play_um: {:.6f}, ball_play_um: {:.6f}}}\n", i + 1,
      to_mm(offset_before + found_zero(axis)), to_um(nut), to_um(share * hexapod.play.ball_joint));
}

std::string axis_text(const IdentifiedAxis& axis) {
  const double zero = found_zero(axis), play = found_play(axis);
  const std::string name = machine::quoted_text(axis.name);
  return axis.angle ? fmt::format("  - {{axis: {}, zero_deg: {:.9f}, play_arcmin: {:.6f}}}\n", name,
                                  to_deg(zero), 60 * to_deg(play))
                    : fmt::format("  - {{axis: {}, zero_mm: {:.9f}, play_um: {:.6f}}}\n", name, to_mm(zero),
                                  to_um(play));
}

std::string drive_text(const IdentifiedAxis& axis, std::size_t i) {
  if (!axis.load) return {};
  const double sine = axis.load->of(AxisParameter::sine), cosine = axis.load->of(AxisParameter::cosine);
  return fmt::format("  - {{drive: {}, lead_permille: {:.9f}, periodic_um: {:.6f}, phase_deg: {:.6f}}}\n",
                     i + 1, 1e3 * axis.load->of(AxisParameter::scale), to_um(std::hypot(sine, cosine)),
                     to_deg(std::atan2(cosine, sine)));
}

}  // namespace

std::string as_built_text(const Identification& found) {
  std::string out = fmt::format("# As built, identified from {}.\nmachine: {}\n", printable(found.record),
                                machine::quoted_text(found.machine.name));
  const bool chain = found.machine.is_chain();
  out += chain ? "axes:\n" : "struts:\n";
  for (std::size_t i = 0; i < found.axes.size(); ++i) {
    const IdentifiedAxis& axis = found.axes[i];
    if (chain) {
      out += axis_text(axis);
      continue;
    }
    const machine::HexapodModel& hexapod = found.machine.hexapod();
    const double before = hexapod.geometry.length_offset[i] - (found.geometry_written ? found_zero(axis) : 0);
    out += strut_text(hexapod, before, axis, i);
  }
  std::string drives;
  for (std::size_t i = 0; i < found.axes.size(); ++i) drives += drive_text(found.axes[i], i);
  return drives.empty() ? out : out + "drives:\n" + drives;
}

}  // namespace understudy::calibration
