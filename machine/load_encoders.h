// Encoders on what the axes carry, behind their play. A controller steers without them, so they stand in the
// machine file and not in the description.
#pragma once

#include <string>

#include "core/yaml/yaml_map.h"

namespace understudy::machine {

struct LoadEncoderCounts {
  double length = 0;  ///< [m], a count of those of struts and slides; 0: they have none
  double angle = 0;   ///< [rad], of those of turns
  double of(bool turns) const { return turns ? angle : length; }
};

/// The optional section `load_encoders`.
void read_load_encoders(YamlMap& root, LoadEncoderCounts& counts);

/// Of a machine file or a name, as load_machine() finds it; throws InputError as that does.
LoadEncoderCounts load_encoder_counts(const std::string& name_or_path);

}  // namespace understudy::machine
