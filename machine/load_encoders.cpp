#include "machine/load_encoders.h"

namespace understudy::machine {

void read_load_encoders(YamlMap& root, LoadEncoderCounts& counts) {
  if (!root.has("load_encoders")) return;
  root.section("load_encoders", "encoders behind the play of the axes", [&](YamlMap& map) {
    if (map.has("count_um"))
      counts.length = map.quantity("count_um", {0.001, 1000}, "of the encoders of struts and slides");
    if (map.has("count_arcmin"))
      counts.angle = map.quantity("count_arcmin", {1e-4, 60}, "of the encoders of axes that turn");
  });
}

}  // namespace understudy::machine
