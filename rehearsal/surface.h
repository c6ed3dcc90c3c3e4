// The surface as printed: its roughness along a line, its deviation from the intended part, the part as a
// file.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "rehearsal/record.h"
#include "rehearsal/request/request.h"
#include "sim/deposition/workpiece.h"

namespace understudy::rehearsal {

/// What the request names, read and checked before anything runs.
struct SurfaceTask {
  std::shared_ptr<const geometry::Mesh> intended;  ///< null: none is named
  SurfaceRequest request;
  bool wanted() const { return intended || !request.profile_mm.empty() || !request.as_printed.empty(); }
};

/// Throws InputError for an intended part that is none, a file name that ends in neither .stl nor .ply, a
/// line without length.
SurfaceTask prepare_surface(const SurfaceRequest& request);

/// Fills record.surface and record.profile, and writes the part. What cannot be measured on this print (a
/// line that misses it) is a finding of kind "unreachable", for the print itself is done.
void study_surface(const SurfaceTask& task, const sim::Workpiece& workpiece, Record& record);

}  // namespace understudy::rehearsal
