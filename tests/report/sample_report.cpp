// Writes the sample records as results into folders, to look at the pages: sample_report FOLDER [MOVES]
// MOVES makes a large one besides.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/file/output_file.h"
#include "report/page/comparison_page.h"
#include "report/page/write_results.h"
#include "tests/report/sample_record.h"
#include "tests/report/sample_replay.h"

namespace {

using understudy::rehearsal::Record;
using namespace understudy::report;

Record with_replay(Record record) {
  add_sample_replay(record);
  return record;
}

/// Names that a page must not take for markup.
Record hostile() {
  Record record = with_replay(sample_no_go());
  const std::string evil = "</script><script>window.evil = 1</script><img src=x onerror='window.evil = 2'>";
  record.title = record.program_name = record.machine_name = record.fixture_name = evil;
  for (auto& finding : record.findings) finding.message = evil;
  record.replay->program = "; " + evil + "\nG1 X1 ; \" onmouseover=\"window.evil = 3\n";
  record.replay->features = {{1, evil}};
  record.replay->bodies.front().shape.name = evil;
  return record;
}

Record calibrated() {
  Record record = with_replay(sample_go());
  record.calibration = understudy::rehearsal::CalibrationFigures{
      "hexapod", "m.yaml", "", understudy::rehearsal::AccuracyFigures{4000, 5000, 6000, 7, 0},
      understudy::rehearsal::AccuracyFigures{40, 50, 60, 0.7, 0}};
  record.trace_before_calibration = record.trace_without_gap_control;
  return record;
}

/// The controller states what it believes of the gap.
Record believing() {
  Record record = with_replay(sample_go());
  record.gap_belief_note = "of the gap read at the start";
  for (const auto& point : record.trace)
    record.gap_beliefs.push_back(
        {0.13e-3, point.extruding ? 5e-6 : std::numeric_limits<double>::quiet_NaN()});
  record.gap->stated_sigma_um = 5;
  record.gap->stated_path_fraction = 1;
  record.gap->inside_stated_3_sigma_fraction = 0.25;
  return record;
}

/// Nothing below the nozzle anywhere, nothing deposited.
Record in_air() {
  Record record = with_replay(sample_go());
  for (auto& point : record.trace) point.gap = std::numeric_limits<double>::infinity();
  record.scene->printed.reset();
  return record;
}

/// The page of two samples beside each other, in FOLDER/compared.
void write_compared(const std::filesystem::path& folder, const std::string& a, const std::string& b) {
  const RecordedRehearsal first = read_recorded_rehearsal(folder / a),
                          second = read_recorded_rehearsal(folder / b);
  const std::filesystem::path page = folder / "compared" / (a + "-" + b + ".html");
  std::filesystem::create_directories(page.parent_path());
  understudy::write_file(page, comparison_html(compare_rehearsals(first, second), first, second));
  std::cout << page.string() << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: sample_report FOLDER [MOVES]\n";
    return 2;
  }
  std::vector<std::pair<std::string, Record>> samples;
  samples.emplace_back("go", with_replay(sample_go()));
  samples.emplace_back("no-go", with_replay(sample_no_go()));
  samples.emplace_back("without-gap-control", with_replay(sample_without_gap_control()));
  samples.emplace_back("stopped", sample_stopped_by_constraints());
  samples.emplace_back("without-replay", sample_go());
  samples.emplace_back("in-air", in_air());
  samples.emplace_back("calibrated", calibrated());
  samples.emplace_back("believing", believing());
  samples.emplace_back("hostile", hostile());
  if (argc == 3) samples.emplace_back("large", sample_large(std::atoi(argv[2])));
  for (auto& [name, record] : samples) {
    record.provenance.inputs_sha256 = std::string(64, 'a');
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / name;
    std::filesystem::create_directories(folder);
    const bool ran = !record.trace.empty();
    write_results(record, ran ? sample_pictures : DrawPictures(), folder);
    std::cout << (folder / "report.html").string() << "\n";
  }
  for (const auto& [a, b] : {std::pair("go", "no-go"), {"hostile", "go"}, {"stopped", "go"}, {"go", "go"}})
    write_compared(argv[1], a, b);
}
