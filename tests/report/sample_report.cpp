// Writes the sample records as results into folders, to look at the pages: sample_report FOLDER
#include <filesystem>
#include <iostream>

#include "report/page/write_results.h"
#include "tests/report/sample_record.h"

int main(int argc, char** argv) {
  using namespace understudy::report;
  using understudy::rehearsal::Record;
  if (argc != 2) {
    std::cerr << "usage: sample_report FOLDER\n";
    return 2;
  }
  const std::pair<const char*, Record> samples[] = {{"go", sample_go()},
                                                    {"no-go", sample_no_go()},
                                                    {"without-gap-control", sample_without_gap_control()},
                                                    {"stopped", sample_stopped_by_constraints()}};
  for (const auto& [name, record] : samples) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / name;
    std::filesystem::create_directories(folder);
    const bool ran = !record.trace.empty();
    write_results(record, ran ? sample_pictures() : std::vector<Illustration>(), folder);
    std::cout << (folder / "report.html").string() << "\n";
  }
}
