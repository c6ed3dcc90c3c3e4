#include "report/page/calibration_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "core/units.h"
#include "report/chart/calibration_charts.h"
#include "report/markup.h"
#include "report/page/page_parts.h"

namespace understudy::report {
namespace {

using namespace calibration;

std::string figure(const std::string& label, const std::string& value, const std::string& aside) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd><div class=\"aside\">{}</div></div>", label, value, aside);
}

std::string chart(const std::string& svg, const std::string& caption) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", svg, caption);
}

std::string warnings(const MachineCalibration& result) {
  if (result.warnings.empty())
    return "<p class=\"note\">The data support the model: residuals are what the stated noise explains.</p>";
  std::string out = "<ul>";
  for (const std::string& warning : result.warnings)
    out += "<li><span class=\"severity warning\">warning</span> " + html_text(warning) + "</li>";
  return out + "</ul>";
}

std::string key_figures(const MachineCalibration& result) {
  const auto um = [](double v) {
    if (!std::isfinite(v)) return std::string("not known");
    return v < 1e-3 ? fmt::format("{:.1f} µm", to_um(v)) : fmt::format("{:.3f} mm", to_mm(v));
  };
  return "<dl class=\"key-figures\">" +
         figure("Tip uncertainty left, 1 sigma", um(result.tip.median),
                "median; worst " + um(result.tip.worst)) +
         figure("Tip error of the old model", um(result.tip.moved_median),
                "median over the same poses; worst " + um(result.tip.moved_worst)) +
         figure("Tip residual", um(residual_rms(result, false)),
                "RMS; before " + um(residual_rms(result, true))) +
         figure("Chi-square", fmt::format("{:.1f}", result.chi_square),
                fmt::format("{} degrees of freedom", result.degrees_of_freedom)) +
         "</dl>";
}

std::string residual_section(const MachineCalibration& result) {
  const bool chain = result.machine.is_chain();
  return "<section><h2>Residuals</h2><div class=\"pictures\">" +
         chart(pose_chart(result), "Measured tip less calibrated model, pose by pose. Grey: rejected.") +
         chart(spread_chart(result),
               chain ? "Whitened pose residuals by coordinate; dashed: 2 sigma."
                     : "Strut length by the measured pose less by the drive, over what the "
                       "pose's noise makes of it; dashed: 2 sigma.") +
         chart(quantile_chart(result),
               "Ordered residuals in units of the stated noise, enlarged for the fitted parameters. On the "
               "line: the "
               "noise is as stated. Steeper: it is understated; flatter: overstated, or alike in all poses. "
               "Tails that bend away: outliers.") +
         "</div></section>";
}

std::string tip_section(const MachineCalibration& result) {
  double top = 0;
  for (const auto& slice : result.tip.slices)
    for (const double s : slice.sigma)
      if (std::isfinite(s)) top = std::max(top, s);
  const std::string scope =
      result.frame
          ? fmt::format(
                "Play and thermal drift are not in it; what the measuring frame errs alike in all poses "
                "is: {:.1f} µm, {:.3f} mrad and {:.3f} ‰.",
                to_um(result.frame->position), 1e3 * result.frame->rotation, 1e3 * result.frame->strain)
          : "Play, thermal drift and the frame of the measuring device are not in it.";
  std::string out = fmt::format(
      "<section><h2>Tip uncertainty over the work space</h2><p class=\"note\">3D, 1 sigma, of the tip where "
      "the "
      "calibrated machine sends it. {} Planes through home at home's orientation; white cannot be reached. "
      "The "
      "figures above are over {} poses of the 100 mm cube about home, tilted to 20 degrees.</p>{}<div "
      "class=\"pictures\">",
      scope, result.tip.poses, heat_key(std::max(top, 1e-12)));
  for (const auto& slice : result.tip.slices)
    out += chart(slice_chart(slice, std::max(top, 1e-12)), fmt::format("{}, {} plane", slice.u, slice.v));
  return out + "</div></section>";
}

std::string parameter_section(const MachineCalibration& result) {
  std::string out = fmt::format(
      "<section><h2>Parameters</h2><p class=\"note\">Parameters are correlated (up to {:.4f} between two of "
      "them): a "
      "large sigma here may cost nothing at the tip. Judge by the "
      "tip.</p><table><thead><tr><th>parameter</th><th "
      "class=\"number\">before</th><th class=\"number\">after</th><th class=\"number\">change</th><th "
      "class=\"number\">sigma</th><th>unit</th></tr></thead><tbody>",
      result.correlation_max);
  for (const ParameterLine& p : result.parameters)
    out += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{:.4f}</td><td class=\"number\">{:.4f}</td><td "
        "class=\"number\">{:+.4f}</td><td class=\"number\">{}</td><td>{}</td></tr>",
        html_text(p.name), p.before, p.after, p.after - p.before,
        std::isfinite(p.sigma) ? fmt::format("{:.4f}", p.sigma) : "–", p.unit == "um" ? "µm" : p.unit);
  out += "</tbody></table>";
  if (!result.redundant.empty()) {
    out += "<p class=\"note\">Redundant beside these, and left as they are:";
    for (const std::string& name : result.redundant) out += " " + html_text(name) + ";";
    out.back() = '.';
    out += "</p>";
  }
  return out + "</section>";
}

}  // namespace

std::string calibration_html(const MachineCalibration& result) {
  const std::string title = html_text(fmt::format("{}, calibrated from {}", result.machine.name,
                                                  std::filesystem::path(result.file).filename().string()));
  return fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>{0}</title><style>{1}</style></head><body><main><p "
      "class=\"eyebrow\">Understudy calibration, estimator {2}</p><h1>{0}</h1>{3}{4}{5}{6}{7}<section>"
      "<h2>How to repeat it</h2><code>{8}</code></section></main></body></html>\n",
      title, kPageStyle, html_text(result.estimator), warnings(result), key_figures(result),
      residual_section(result), tip_section(result), parameter_section(result), html_text(result.command));
}

}  // namespace understudy::report
