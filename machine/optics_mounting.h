// Where laser and microscope sit: as drawn, as a calibration found them, and moved by an error of the
// mounting.
#pragma once

#include "machine/description.h"

namespace understudy::machine {

/// What the controller reckons with.
OpticsMounting mounting_of(const MachineDescription& machine);

/// What the file's sections `laser` and `microscope` say, whatever a calibration has found since.
OpticsMounting drawn_mounting(const MachineDescription& machine);

/// [m], of the beam, as the file's section `laser` says, whatever a calibration has found since.
double drawn_waist(const MachineDescription& machine);

/// `from` with each device moved in its own frame: turned about its origin, and offset.
OpticsMounting moved(const OpticsMounting& from, const MountingVector& error);

void set_mounting(const OpticsMounting& mounting, Laser& laser, Microscope& microscope);

/// `brown`: k1, k2, p1, p2.
void set_distortion(const std::vector<double>& brown, Camera& camera);

/// [px/m] where the beam crosses the tip plane: within a few per cent of that at any gap.
double picture_scale(const MachineDescription& machine);

/// 1 sigma of each freedom.
MountingVector mounting_sigmas(const MountingTolerances& tolerances);

/// "laser offset x", ...
const char* mounting_freedom(int index);
/// What one unit of the freedom is in the file: mm, rad, or 1; and "um", "mrad" or "permille" for reports,
/// with `report_unit` of it in SI.
double mounting_file_unit(int index);
const char* mounting_report_unit(int index, double& si);

}  // namespace understudy::machine
