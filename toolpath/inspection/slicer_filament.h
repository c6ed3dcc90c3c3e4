// How much filament a print needs, as the slicer's comment says.
#pragma once

#include <optional>
#include <string_view>

namespace understudy::toolpath {

/// [m], of all extruders together; nothing where no comment tells. Read are those of PrusaSlicer,
/// SuperSlicer, OrcaSlicer and Slic3r ("filament used [mm] = 264.59"), Cura ("Filament used: 0.27m"),
/// BambuStudio ("total filament length [mm] : 1503.6"), Kiri:Moto, ideaMaker ("Material#1 Used: 422.7"),
/// Simplify3D and KISSlicer.
std::optional<double> told_filament(std::string_view text);

}  // namespace understudy::toolpath
