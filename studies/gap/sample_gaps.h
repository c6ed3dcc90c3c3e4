// Pictures that calibrate a gap sensor, of a twin whose laser and microscope sit as its tolerances allow.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "calibration/gap_sensor/gap_picture_table.h"
#include "core/image.h"
#include "machine/description.h"

namespace understudy::studies {

struct SampleGapsRequest {
  std::vector<double> heights;  ///< [m], commanded
  double wedge = 0;             ///< [rad]; above 0: over two wedges, too, that lean towards x and towards y
  double feeler = 0.1e-3;       ///< [m], the gap that is known over each flat
  double feeler_sigma = 5e-6;   ///< [m]
  double height_sigma = 0;      ///< [m], of each commanded height
  bool speckle = true;
  std::string as_built = "manufactured";  ///< of sim::make_as_built
  std::uint64_t seed = 1;
};

struct SampledGaps {
  std::string table;     ///< as `calibrate gap-sensor` takes it
  std::string truth;     ///< CSV: the gap of each picture
  std::string as_built;  ///< the machine that stood there, as sim::read_as_built() takes it
  int pictures = 0;
  calibration::GapPictureTable rows;  ///< the same as read: without file, lines and files of pictures
};

/// `keep` is given each picture and the name that the table has for it. Throws InputError for heights that
/// are none, and for a machine without a microscope.
SampledGaps sample_gaps(const SampleGapsRequest& request, const machine::MachineDescription& machine,
                        const std::function<void(const std::string& name, const Image& picture)>& keep);

}  // namespace understudy::studies
