// Bytes as a map of columns, and behind a line "---" the table that it is a map of, of a hexapod and of an
// arm.
#include <algorithm>

#include "calibration/table/measured_rows.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

constexpr std::ptrdiff_t kMostRows = 20;
// What fits no machine is read in some 50 other ways, each of which is fitted, to tell which one would fit.
constexpr std::size_t kFits = 10'000;

void check(const calibration::MeasuredRows& read) {
  require(!read.problem.rows.empty(), "a table without rows");
  for (const calibration::MeasurementRow& row : read.problem.rows) {
    require_finite(row.axes, "axis");
    require_finite(row.X_MG, "pose");
    require_finite(row.distance, "distance");
    require(row.covariance.allFinite(), "a covariance that is not finite");
    require((row.covariance.diagonal().array() >= 0).all(), "a variance below 0");
  }
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile map_file("columns.yaml"), table("rows.csv");
  static const std::vector machines{machine::load_machine("hexapod"), machine::load_machine("arm")};
  const std::string_view text = fuzz::text_of(data, size), mark = "\n---\n";
  const std::size_t end = std::min(text.find(mark), text.size());
  const std::string file = map_file.fill(text.substr(0, end)).string();
  table.fill(text.substr(std::min(end + mark.size(), text.size())));
  calibration::ColumnMap map;
  if (std::count(text.begin() + static_cast<std::ptrdiff_t>(end), text.end(), '\n') > fuzz::kMostRows)
    return 0;
  if (!fuzz::accepts(size, file, [&] { map = calibration::read_column_map(file); })) return 0;
  for (const machine::MachineDescription& machine : machines) {
    calibration::MeasuredRows rows;
    const auto read = [&] { rows = calibration::read_measured_rows(map, {table.path().string()}, machine); };
    // What is refused lies in the map, in its table, or in a file that the map names.
    if (fuzz::accepts(size, "", read, [] { return fuzz::kFits; })) fuzz::check(rows);
  }
  return 0;
}
