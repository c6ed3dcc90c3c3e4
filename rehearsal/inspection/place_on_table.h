// Where `inspect` proposes to put a program that does not lie on the table.
#pragma once

#include <array>

#include "machine/description.h"
#include "toolpath/inspection/program_summary.h"

namespace understudy::rehearsal {

constexpr double kFarAbove = 2e-3;  ///< [m] above the table, where no first layer begins

/// [mm], as `--place` takes it, in thousandths: in x and y so that the middle of the `part` is the table's,
/// where what is `printed`, purge lines too, leaves the table; in z so that the lowest bead lies a `layer`
/// [m] over the table where it is below it, and, if `lowered`, where it is far above. Zeros where it lies
/// well.
std::array<double, 3> place_on_table(const toolpath::Extent& printed, const toolpath::Extent& part,
                                     const machine::MachineDescription& machine, double layer, bool lowered);

}  // namespace understudy::rehearsal
