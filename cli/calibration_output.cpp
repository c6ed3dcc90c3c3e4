#include "cli/calibration_output.h"

#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "machine/file/calibration_section.h"
#include "report/calibration_summary.h"
#include "report/page/calibration_page.h"

namespace understudy::cli {

int write_calibration(const calibration::MachineCalibration& result, const std::string& machine_file,
                      const std::string& report_folder) {
  std::optional<OutputFolder> report;
  if (!report_folder.empty()) {
    report.emplace(report_folder);
    write_file(report->path() / "summary.json", report::calibration_json(result));
    write_file(report->path() / "report.html", report::calibration_html(result));
  }
  stop_if_interrupted();
  machine::write_calibrated(result.machine, machine_file, result.stored);
  if (report) report->commit();
  fmt::print("{}machine: {}\n", report::calibration_text(result), machine_file);
  if (report) fmt::print("report: {}\n", (std::filesystem::path(report_folder) / "report.html").string());
  return kGood;
}

}  // namespace understudy::cli
