// Bytes as an as-built file, of a hexapod and of a chain.
#include "sim/as_built/as_built_file.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

void check(const sim::AsBuilt& built) {
  for (const auto& axis : built.chain.axes) require_finite(axis.point, "point of an axis");
  require_finite(built.part.X_WF, "part");
  require_finite(built.microscope.X_TC, "microscope");
  require_finite(std::vector{built.filament_diameter, built.extruder_lag, built.nozzle_offset,
                             built.part.size, built.part.ripple, built.table.height, built.table.bow},
                 "a number of the built machine");
}

/// What is written reads back, and is then written as the same text but for the last digits: compared as the
/// second and the third writing, whose numbers have settled.
void check_writing(const sim::AsBuilt& built, const sim::AsBuilt& drawn) {
  static const InputFile written("written.yaml");
  const auto again = [&](const sim::AsBuilt& one) {
    sim::AsBuilt read = drawn;
    read.source = one.source;
    sim::read_as_built(written.fill(sim::write_as_built(one)).string(), read);
    return read;
  };
  const sim::AsBuilt once = again(built);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    require_near((once.hexapod.base_joint[i] - built.hexapod.base_joint[i]).norm(), 0, 1e-12, 0,
                 "base joint");
    require_near(once.nut_play[i], built.nut_play[i], 0, 1e-12, "play");
  }
  require(once.chain.axes.size() == built.chain.axes.size(), "another number of axes came back");
  for (std::size_t i = 0; i < built.chain.axes.size(); ++i) {
    require_near((once.chain.axes[i].point - built.chain.axes[i].point).norm(), 0, 1e-12, 0,
                 "point of an axis");
    require_near(once.axis_zero[i], built.axis_zero[i], 0, 1e-12, "zero of an axis");
  }
  require_near((once.part.X_WF.translation() - built.part.X_WF.translation()).norm(), 0, 1e-12, 0, "part");
  require_near(angle_between(once.part.X_WF.linear(), built.part.X_WF.linear()), 0, 1e-7, 0,
               "turn of the part");
  require_near(once.table.bow, built.table.bow, 0, 1e-12, "bow of the table");
  for (std::size_t i = 0; i < built.drives.size(); ++i)
    if (built.drives[i].scale != 0 || built.drives[i].periodic != 0)
      require_near(once.drives[i].phase, built.drives[i].phase, 0, 1e-12, "phase of a drive");
  again(once);
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("as-built.yaml");
  static const std::vector drawn{sim::as_described(machine::load_machine("hexapod")),
                                 sim::as_described(machine::load_machine("five-axis"))};
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  for (const sim::AsBuilt& nominal : drawn) {
    sim::AsBuilt built = nominal;
    if (!fuzz::accepts(size, file, [&] { sim::read_as_built(file, built); })) continue;
    fuzz::check(built);
    fuzz::check_writing(built, nominal);
  }
  return 0;
}
