// The tables of docs/reference.md#calibration-figures for models/hexapod.
//
//   calibration_tables [MACHINES] [SETS] [DRAWS]      (8 8 12)
#include <cstdio>
#include <cstdlib>

#include "core/error.h"
#include "machine/description.h"
#include "studies/calibration/estimator_study_tables.h"

namespace understudy::bench {
namespace {

void run(const studies::TableSize& size) {
  const machine::MachineDescription machine = machine::load_machine("hexapod");
  const auto mechanism = machine.make_mechanism();
  studies::StudySetting setting;
  setting.nominal = machine.hexapod().geometry;
  setting.mechanism = mechanism.get();
  setting.region = calibration::reference_region(machine.X_BT_home);
  studies::study_tables(setting, size, [](const std::string& line) {
    std::puts(line.c_str());
    std::fflush(stdout);
  });
}

}  // namespace
}  // namespace understudy::bench

int main(int argc, char** argv) {
  int counts[3] = {8, 8, 12};
  for (int n = 1; n < argc; ++n) {
    const int value = std::atoi(argv[n]);
    if (n > 3 || value < 1) {
      std::fprintf(stderr, "usage: calibration_tables [MACHINES] [SETS] [DRAWS], each 1 or more\n");
      return 2;
    }
    counts[n - 1] = value;
  }
  try {
    understudy::bench::run({counts[0], counts[1], counts[2]});
  } catch (const understudy::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
