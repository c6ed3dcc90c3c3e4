// Bytes as a table of measured poses, of a hexapod and of a chain.
#include "calibration/machine/measurement_table.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

using calibration::Measurements;

void check(const Measurements& table) {
  require(!table.poses.empty(), "a table without poses");
  for (const auto& pose : table.poses) {
    require_finite(pose.X_WT, "pose");
    require_finite(pose.axes, "axis");
    require(pose.covariance.allFinite(), "a covariance that is not finite");
    require((pose.covariance.diagonal().array() > 0).all(), "a variance that is not above 0");
  }
}

/// Of numbers with 6 significant digits, or 6 decimals of mm or degrees, or 9 of a quaternion.
void check_same(const Measurements& read, const Measurements& written) {
  require(read.poses.size() == written.poses.size(), "another number of poses came back");
  require(read.noise_given == written.noise_given && read.approach_told == written.approach_told,
          "other columns came back");
  for (std::size_t j = 0; j < read.poses.size(); ++j) {
    const auto &r = read.poses[j], &w = written.poses[j];
    require_near((r.X_WT.translation() - w.X_WT.translation()).norm(), 0, 1e-9, 1e-12, "tip");
    require_near(angle_between(r.X_WT.linear(), w.X_WT.linear()), 0, 3e-9, 0, "turn");
    for (std::size_t i = 0; i < w.axes.size(); ++i) require_near(r.axes[i], w.axes[i], 1e-8, 1e-12, "axis");
    require(r.approach == w.approach, "another approach came back");
    if (!written.noise_given) continue;
    const double largest = w.covariance.cwiseAbs().maxCoeff();
    require_near((r.covariance - w.covariance).cwiseAbs().maxCoeff(), 0, 2e-5 * largest, 0, "covariance");
  }
}

void check_writing(const Measurements& table, const machine::MachineDescription& machine) {
  static const InputFile written("written.csv");
  written.fill(calibration::measurements_csv(table, machine, "written"));
  try {
    check_same(calibration::read_measurements(written.path().string(), machine, calibration::kReferenceNoise),
               table);
  } catch (const InputError& error) {
    // Rounding may take a covariance that is barely definite, or a pose at the edge, over it.
    const std::string what = error.what();
    for (const char* edge : {"not positive definite", "median", "struts are", "is 0, not above 0"})
      if (what.find(edge) != std::string::npos) return;
    throw;
  }
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("measured.csv");
  static const std::vector machines{machine::load_machine("hexapod"), machine::load_machine("five-axis")};
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  for (const machine::MachineDescription& machine : machines) {
    calibration::Measurements table;
    const auto read = [&] {
      table = calibration::read_measurements(file, machine, calibration::kReferenceNoise);
    };
    if (!fuzz::accepts(size, file, read)) continue;
    fuzz::check(table);
    fuzz::check_writing(table, machine);
  }
  return 0;
}
