#include "cli/calibration/calibration_output.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "cli/urdf_of.h"
#include "core/file/output_file.h"
#include "core/interrupt.h"
#include "machine/file/beside_machine.h"
#include "machine/file/calibration_section.h"
#include "report/calibration/calibration_summary.h"
#include "report/page/calibration_page.h"

namespace understudy::cli {

CalibrationOutput::CalibrationOutput(std::string machine_file, std::string report_folder,
                                     std::string urdf_file)
    : machine_file_(std::move(machine_file)),
      report_folder_(std::move(report_folder)),
      urdf_file_(std::move(urdf_file)) {
  machine::check_machine_output(machine_file_);
  if (!urdf_file_.empty()) check_writable(urdf_file_);
  if (!report_folder_.empty()) report_.emplace(report_folder_);
}

int CalibrationOutput::write(const calibration::MachineCalibration& result, const OutputOptions& told) {
  if (report_) {
    write_file(report_->path() / "summary.json", report::calibration_json(result));
    write_file(report_->path() / "report.html", report::calibration_html(result));
  }
  StagedFile machine = machine::staged_with_section(
      result.machine.file, machine::calibration_section(result.machine, result.stored), machine_file_);
  std::optional<StagedFile> named = machine::staged_urdf(result.machine.file, machine_file_), corrected;
  const auto companions = machine::staged_companions(result.machine.file, machine_file_);
  if (!urdf_file_.empty()) corrected.emplace(urdf_file_, calibrated_urdf_of(result.machine));
  stop_if_interrupted();
  if (report_) report_->commit();
  if (named) named->commit();
  for (const auto& file : companions) file->commit();
  if (corrected) corrected->commit();
  machine.commit();
  if (told.json) fmt::print("{}", report::calibration_json(result));
  if (told.json) return kGood;
  fmt::print("{}machine: {}\n", told.quiet ? "" : report::calibration_text(result), machine_file_);
  if (told.quiet) return kGood;
  if (!urdf_file_.empty()) fmt::print("urdf: {}\n", urdf_file_);
  if (report_) fmt::print("report: {}\n", (std::filesystem::path(report_folder_) / "report.html").string());
  return kGood;
}

}  // namespace understudy::cli
