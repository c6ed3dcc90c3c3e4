// A scenario whose run takes a fraction of a second.
#pragma once

#include "tests/cli/program_run.h"

namespace understudy::cli_test {

/// s.yaml and its line.gcode: a short straight line in air on a sampled hexapod.
inline void write_line_in_air(const Folder& folder) {
  folder.write("line.gcode", "M104 S230\nG1 X0 Y0 Z60 F3000\nG1 X4 Y0 Z60 E0.3 F600\n");
  folder.write(
      "s.yaml",
      "name: line\ndescription: d\nsource: s\nmachine: hexapod\nprogram: line.gcode\nas_built: sampled\n"
      "seed: 1\ngap_control: off\nengine: quasistatic\nexpect:\n"
      "  - {metric: verdict, equals: go, source: a test}\n");
}

}  // namespace understudy::cli_test
