#include "rehearsal/request/input_digest.h"

#include <filesystem>
#include <functional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

namespace fs = std::filesystem;

class InputDigest : public testing::Test {
 protected:
  InputDigest() {
    request.program = file("a.gcode", "G1 X1\n");
    request.registration.pattern = file("places.csv", "0,0,0\n");
    request.surface.profile_mm = {0, 0, 0, 1, 0, 0};
  }
  std::string file(const std::string& name, const std::string& text) const {
    write_file(folder / name, text);
    return (folder / name).string();
  }

  TemporaryFolder folder;
  RehearsalRequest request;
};

TEST_F(InputDigest, EveryInputCounts) {
  using Change = std::function<void(RehearsalRequest&)>;
  const std::vector<Change> changes{
      [&](auto& r) { r.program = file("b.gcode", "G1 X2\n"); },
      [](auto& r) { r.machine = "arm"; },
      [](auto& r) { r.before = "hexapod"; },
      [](auto& r) { r.engine = "bullet"; },
      [](auto& r) { r.fixture = "bottle"; },
      [](auto& r) { r.fixture = "crown"; },
      [](auto& r) { r.material = "pla"; },
      [](auto& r) { r.as_built = "manufactured"; },
      [&](auto& r) { r.as_built = file("built.yaml", "zeros: 1\n"); },
      [](auto& r) { r.seed = 2; },
      [](auto& r) { r.truth_seeds.emplace(1)[sim::TruthGroup::noise] = 2; },
      [](auto& r) { r.gap_control = "off"; },
      [](auto& r) { r.tip_tolerance_mm = 0.1; },
      [](auto& r) { r.orientation_tolerance_deg = 0.1; },
      [](auto& r) {
        r.faults.push_back({{sim::FaultKind::stall, 0, 1, 0, 0.4, 0}, "l3", false, {}});
      },
      [](auto& r) {
        r.faults.push_back({{sim::FaultKind::stall, 0, 1, 0, 0.4, 0}, "l4", false, {}});
      },
      [](auto& r) {
        r.camera_faults.push_back({{sim::CameraFaultKind::dim, 1, 1, 0.5}, {}});
      },
      [](auto& r) { r.dialect.place_mm[2] = 1e-9; },
      [](auto& r) { r.dialect.extruder_letter = "A"; },
      [](auto& r) { r.dialect.b_sign = -1; },
      [](auto& r) { r.dialect.c_sign = -1; },
      [](auto& r) { r.dialect.coordinates = "machine"; },
      [](auto& r) { r.dialect.ignored = {"G29"}; },
      [&](auto& r) { r.dialect.macros = file("a.cfg", "[gcode_macro A]\ngcode: G28\n"); },
      [&](auto& r) {
        file("part.cfg", "[gcode_macro B]\ngcode: G28\n");
        r.dialect.macros = file("b.cfg", "[gcode_macro A]\ngcode: G28\n[include part.cfg]\n");
      },
      [](auto& r) { r.dialect.nozzle_mm = 0.6; },
      [](auto& r) { r.dialect.layer_mm = 0.3; },
      [](auto& r) { r.dialect.temperature_c = 200; },
      [](auto& r) { r.dialect.strict = true; },
      [](auto& r) { r.dialect.relative_extrusion = true; },
      [](auto& r) { r.dialect.place_auto = true; },
      [](auto& r) { r.dialect.turn_deg = 1e-9; },
      [](auto& r) { r.dialect.spin_deg = 1e-9; },
      [](auto& r) { r.home_axes = {1}; },
      [](auto& r) { r.surface.intended = "bottle"; },
      [](auto& r) { r.surface.profile_mm[3] = 2; },
      [](auto& r) {
        r.surface.probe = {0, -1, 0};
      },
      [](auto& r) { r.registration.wanted = true; },
      [](auto& r) { r.registration.places = 8; },
      [&](auto& r) { r.registration.pattern = file("others.csv", "1,0,0\n"); },
      [](auto& r) { r.compare_without_gap_control = false; },
      [](auto& r) { r.max_time = 3600; },
  };
  std::set<std::string> digests{inputs_sha256(request)};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    RehearsalRequest changed = request;
    changes[i](changed);
    EXPECT_TRUE(digests.insert(inputs_sha256(changed)).second) << "change " << i << " makes no difference";
  }
}

TEST_F(InputDigest, NamesAndOutputsDoNotCount) {
  RehearsalRequest moved = request;
  moved.program = file("moved.gcode", "G1 X1\n");
  moved.machine = (machine::models_folder() / "hexapod" / "machine.yaml").string();
  moved.command = "understudy rehearse moved.gcode";
  moved.surface.as_printed = "out.stl";
  moved.keep_scene = false;
  EXPECT_EQ(inputs_sha256(moved), inputs_sha256(request));
}

TEST_F(InputDigest, WhatCannotBeReadIsAnError) {
  request.program = (folder / "none.gcode").string();
  EXPECT_THROW(inputs_sha256(request), InputError);
}

TEST_F(InputDigest, BytesOfIncludedMacrosCount) {
  file("part.cfg", "[gcode_macro B]\ngcode: G28\n");
  request.dialect.macros = file("b.cfg", "[include part.cfg]\n");
  const std::string before = inputs_sha256(request);
  file("part.cfg", "[gcode_macro B]\ngcode: G29\n");
  EXPECT_NE(inputs_sha256(request), before);
}

}  // namespace
}  // namespace understudy::rehearsal
