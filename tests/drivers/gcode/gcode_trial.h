// A port of drivers/gcode with a scripted controller behind a simulated line.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "drivers/gcode/gcode_port.h"
#include "tests/drivers/gcode/scripted_controller.h"
#include "tests/drivers/gcode/simulated_link.h"

namespace understudy::drivers {

struct GcodeTrial {
  std::shared_ptr<ScriptedController> controller;
  std::unique_ptr<GcodePort> port;
};

inline const machine::MachineDescription& trial_machine() {
  static const machine::MachineDescription hexapod = machine::load_machine("hexapod");
  return hexapod;
}

inline const char* family_word(Firmware firmware) {
  return firmware == Firmware::grblhal  ? "grblhal"
         : firmware == Firmware::marlin ? "marlin"
                                        : "reprapfirmware";
}

/// A hexapod at home. `options` of the URI follow the family's.
inline GcodeTrial make_trial(Firmware firmware, const Mischief& mischief = {}, SimulatedLink::Setup line = {},
                             const std::string& options = "") {
  const PortUri uri =
      parse_port_uri(std::string("serial:///dev/none?outputs=yes&family=") + family_word(firmware) + options);
  const GcodeSetup setup = gcode_setup(uri, trial_machine());
  ScriptedController::Setup peer;
  peer.firmware = firmware;
  peer.letters = firmware == Firmware::grblhal ? "XYZABC" : "XYZUVW";
  peer.extruder = firmware == Firmware::grblhal ? 'U' : 'E';
  std::array<double, 8> home{};
  const auto mechanism = trial_machine().make_mechanism();
  static_cast<void>(mechanism->inverse(trial_machine().X_BT_home, {}, std::span(home).first(6)));
  for (double& value : home) value = std::round(value * 1e5) * 1e-2;  // what every family can say
  peer.start = home;
  GcodeTrial trial;
  trial.controller = std::make_shared<ScriptedController>(peer, mischief);
  trial.port = std::make_unique<GcodePort>(std::make_unique<SimulatedLink>(trial.controller, line), setup,
                                           trial_machine());
  return trial;
}

}  // namespace understudy::drivers
