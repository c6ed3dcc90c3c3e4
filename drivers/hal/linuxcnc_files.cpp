#include "drivers/hal/linuxcnc_files.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "drivers/pose_words.h"

namespace understudy::drivers {
namespace {

constexpr int kCurvePoints = 16;     // that the component lincurve holds
constexpr double kCurveRoom = 2;     // [mm], of the curve beyond the struts' range
constexpr double kIdleHeat = 600;    // [s], at rest, after which the heater goes off
constexpr double kFeedRoom = 1.001;  // the filament ends with its block, not a rounding later
constexpr double kTipPerStrut = 4;   // limit of the tip's speed against that of a strut

struct Figures {
  const machine::MachineDescription& machine;
  HalSettings settings;
  double deviation = 0;  // [mm]

  const HalAxis& strut(std::size_t i) const { return settings.axes[i]; }
  double joint(double length) const { return std::hypot(length, deviation); }  // [mm]
};

template <typename Text>
std::string each_strut(const Figures& f, const Text& text) {
  std::string all;
  for (std::size_t i = 0; i < f.settings.machine_axes; ++i) all += text(f.strut(i), i);
  return all;
}

std::string header(const Figures& f, const char* what) {
  return fmt::format("# {}: {}\n# Written by `understudy export linuxcnc`; units are mm and degrees.\n\n",
                     f.settings.machine, what);
}

/// Where genhexkins begins to look for the pose of its joints: elsewhere it finds none.
std::string home_words(const Figures& f) {
  const machine::AxisVector words = pose_words(f.machine.X_BT_home);
  std::string text;
  for (std::size_t i = 0; i < kPoseWords; ++i)
    text += fmt::format("{}{:.9g}", i == 0 ? "" : " ", i < 3 ? to_mm(words[i]) : to_deg(words[i]));
  return text;
}

std::string trajectory(const Figures& f) {
  const HalAxis& strut = f.strut(0);
  const double speed = kTipPerStrut * strut.velocity, acceleration = strut.acceleration;
  const double turn = 2 * to_deg(f.machine.orientation_velocity);
  const double turn_acceleration =
      to_deg(acceleration / to_mm(f.machine.hexapod().geometry.platform_joint[0].norm()));
  std::string text = fmt::format(
      "[TRAJ]\nCOORDINATES = X Y Z A B C\nLINEAR_UNITS = mm\nANGULAR_UNITS = degree\nNO_FORCE_HOMING = 1\n"
      "HOME = {4}\n"
      "DEFAULT_LINEAR_VELOCITY = {0:.6g}\nMAX_LINEAR_VELOCITY = {0:.6g}\n"
      "DEFAULT_LINEAR_ACCELERATION = {1:.6g}\nMAX_LINEAR_ACCELERATION = {1:.6g}\n"
      "DEFAULT_ANGULAR_VELOCITY = {2:.6g}\nMAX_ANGULAR_VELOCITY = {2:.6g}\n"
      "DEFAULT_ANGULAR_ACCELERATION = {3:.6g}\nMAX_ANGULAR_ACCELERATION = {3:.6g}\n\n",
      speed, acceleration, turn, turn_acceleration, home_words(f));
  for (const char axis : std::string("XYZABC"))
    text += fmt::format(
        "[AXIS_{}]\nMIN_LIMIT = -1e6\nMAX_LIMIT = 1e6\nMAX_VELOCITY = {:.6g}\nMAX_ACCELERATION = {:.6g}\n\n",
        axis, axis < 'D' ? turn : speed, axis < 'D' ? turn_acceleration : acceleration);
  return text;
}

std::string ini_file(const Figures& f) {
  return header(f, "LinuxCNC's planner and kinematics, commanded through linuxcncrsh") +
         fmt::format(
             "[EMC]\nVERSION = 1.1\nMACHINE = {}\nDEBUG = 0\n\n"
             "[DISPLAY]\nDISPLAY = linuxcncrsh\nCYCLE_TIME = 0.05\nMAX_FEED_OVERRIDE = 1\n\n"
             "[RS274NGC]\nPARAMETER_FILE = machine.var\nSUBROUTINE_PATH = .\n"
             "RS274NGC_STARTUP_CODE = G21 G90 G40 G49 G80 G17\n\n"
             "[EMCMOT]\nEMCMOT = motmod\nCOMM_TIMEOUT = 1.0\nSERVO_PERIOD = {:.0f}\n\n"
             "[TASK]\nTASK = milltask\nCYCLE_TIME = 0.001\n\n"
             "[EMCIO]\nEMCIO = io\nCYCLE_TIME = 0.1\nTOOL_TABLE = tool.tbl\n\n"
             "[HAL]\nHALFILE = machine.hal\nHALFILE = pins.hal\n\n"
             "[KINS]\nKINEMATICS = genhexkins\nJOINTS = 6\n\n",
             f.settings.machine, f.settings.cycle * 1e9) +
         trajectory(f) + each_strut(f, [&](const HalAxis& a, std::size_t i) {
           return fmt::format(
               "# {0}; a joint is the distance of base joint and ball joint\n[JOINT_{1}]\nTYPE = LINEAR\n"
               "MIN_LIMIT = {2:.9g}\nMAX_LIMIT = {3:.9g}\nMAX_VELOCITY = {4:.6g}\nMAX_ACCELERATION = "
               "{5:.6g}\n"
               "FERROR = {6:.6g}\nMIN_FERROR = {6:.6g}\n"
               "HOME = {7:.12g}\nHOME_OFFSET = {7:.12g}\nHOME_SEQUENCE = 0\n\n",
               a.name, i, f.joint(a.lower), f.joint(a.upper), a.velocity, a.acceleration, a.following,
               f.joint(a.home));
         });
}

std::string names(const Figures& f, const char* prefix) {
  return each_strut(f, [&](const HalAxis& a, std::size_t i) {
    return fmt::format("{}{}.{}", i == 0 ? "" : ",", prefix, a.name);
  });
}

std::string kinematics(const Figures& f) {
  const kinematics::HexapodGeometry& g = f.machine.hexapod().geometry;
  std::string text = "# Base joints in the base's frame, ball joints from the nozzle's tip.\n";
  for (std::size_t i = 0; i < f.settings.machine_axes; ++i)
    for (int k = 0; k < 3; ++k)
      text +=
          fmt::format("setp genhexkins.base.{0}.{1} {2:.12g}\nsetp genhexkins.platform.{0}.{1} {3:.12g}\n", i,
                      "xyz"[k], to_mm(g.base_joint[i][k]), to_mm(g.platform_joint[i][k]));
  return text +
         "setp genhexkins.screw-lead 0\nsetp genhexkins.spindle-offset 0\nsetp genhexkins.tool-offset 0\n\n";
}

/// Strut length of a joint, and back: straight between points, of which the drives' way in and out is the
/// same.
std::string curve(const Figures& f, const HalAxis& a) {
  std::string text;
  const double first = a.lower - kCurveRoom, width = a.upper - a.lower + 2 * kCurveRoom;
  for (int k = 0; k < kCurvePoints; ++k) {
    const double length = first + width * k / (kCurvePoints - 1);
    const double joint = f.joint(length) - f.joint(a.home);  // as motors count: from home
    text += fmt::format(
        "setp length.{0}.x-val-{1:02} {3:.12g}\nsetp length.{0}.y-val-{1:02} {2:.12g}\n"
        "setp back.{0}.x-val-{1:02} {2:.12g}\nsetp back.{0}.y-val-{1:02} {3:.12g}\n",
        a.name, k, length, joint);
  }
  return text;
}

std::string strut_nets(const Figures& f) {
  return each_strut(f, [&](const HalAxis& a, std::size_t i) {
    return curve(f, a) + fmt::format(
                             "net {0}-joint joint.{1}.motor-pos-cmd => length.{0}.in\n"
                             "net {0}-length length.{0}.out => zero.{0}.in\n"
                             "setp zero.{0}.offset {2:.12g}\n"
                             "net {0}-command zero.{0}.out\n"
                             "net {0}-drive => zero.{0}.fb-in\n"
                             "net {0}-feedback zero.{0}.fb-out => back.{0}.in\n"
                             "net {0}-joint-feedback back.{0}.out => joint.{1}.motor-pos-fb\n"
                             "net {0}-enable joint.{1}.amp-enable-out\n"
                             "net {0}-limit-switch => joint.{1}.neg-lim-sw-in joint.{1}.pos-lim-sw-in\n"
                             "net {0}-home-switch => joint.{1}.home-sw-in\n\n",
                             a.name, i, -a.home);
  });
}

std::string functions(const Figures& f) {
  std::string text = "addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n";
  const auto add = [&](const char* prefix, const char* suffix) {
    text += each_strut(f, [&](const HalAxis& a, std::size_t) {
      return fmt::format("addf {}.{}{} servo-thread\n", prefix, a.name, suffix);
    });
  };
  add("length", "");
  add("zero", ".update-output");
  add("zero", ".update-feedback");
  add("back", "");
  return text +
         "addf feed-room servo-thread\naddf feeder servo-thread\naddf idle servo-thread\naddf warm "
         "servo-thread\n"
         "addf may-heat servo-thread\naddf heater.gate servo-thread\naddf fan.gate servo-thread\n\n";
}

std::string machine_file(const Figures& f) {
  return header(f, "kinematics, feeder, and what belongs to every machine") +
         fmt::format(
             "loadrt [KINS]KINEMATICS\n"
             "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS "
             "num_aio=4\n"
             "loadrt lincurve names={},{} personality={}\nloadrt offset names={}\n"
             "loadrt limit2 names=feeder\nloadrt scale names=feed-room\nloadrt timedelay names=idle\n"
             "loadrt not names=warm\nloadrt and2 names=may-heat\nloadrt mux2 names=heater.gate,fan.gate\n\n",
             names(f, "length"), names(f, "back"),
             each_strut(f,
                        [](const HalAxis&, std::size_t i) {
                          return fmt::format("{0}{1},{1}", i == 0 ? "" : ",", kCurvePoints);
                        }),
             names(f, "zero")) +
         functions(f) + kinematics(f) + strut_nets(f) +
         fmt::format(
             "# Filament [mm] and its speed come with each block, and the feeder goes there.\n"
             "net filament-planned motion.analog-out-00 => feeder.in\n"
             "net filament-speed motion.analog-out-01 => feed-room.in\n"
             "setp feed-room.gain {:.6g}\n"
             "net filament-maxv feed-room.out => feeder.maxv\n"
             "net filament-command feeder.out\n\n"
             "# Heater [deg C] and fan [0..1]: off with the machine; the heater after {:.0f} s at rest, "
             "too.\n"
             "net machine-on motion.motion-enabled => may-heat.in0 fan.gate.sel\n"
             "net rests motion.in-position => idle.in\nsetp idle.on-delay {:.0f}\nsetp idle.off-delay 0\n"
             "net idle idle.out => warm.in\nnet warm warm.out => may-heat.in1\n"
             "net may-heat may-heat.out => heater.gate.sel\n"
             "net nozzle-planned motion.analog-out-02 => heater.gate.in1\nnet nozzle-setpoint "
             "heater.gate.out\n"
             "net fan-planned motion.analog-out-03 => fan.gate.in1\nnet fan-setpoint fan.gate.out\n"
             "net nozzle-is-hot => motion.digital-in-00\n\n"
             "net emergency-stop-ok => iocontrol.0.emc-enable-in\n"
             "net no-tool iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n"
             "net no-change iocontrol.0.tool-change => iocontrol.0.tool-changed\n",
             kFeedRoom, kIdleHeat, kIdleHeat);
}

std::string pins_file(const Figures& f) {
  return header(f, "drives, emergency stop, heater and fan: simulated") +
         "# A real machine replaces all lines below (README.md): step generators or other drives take\n"
         "# STRUT-command and give STRUT-drive, both counted from home.\n"
         "loadrt mux4 names=" +
         names(f, "drive") + "\n" +
         each_strut(f,
                    [](const HalAxis& a, std::size_t) {
                      return fmt::format(
                          "addf drive.{0} servo-thread\n"
                          "net {0}-command => drive.{0}.in1\nnet {0}-drive drive.{0}.out => drive.{0}.in0\n"
                          "net {0}-enable => drive.{0}.sel0\n",
                          a.name);
                    }) +
         "sets nozzle-is-hot 1\n"
         "net emergency-stop-ok iocontrol.0.user-enable-out\n";
}

std::string readme(const Figures& f) {
  std::string text = fmt::format(
      "# {0} on LinuxCNC's own planner and kinematics\n\n"
      "Written by `understudy export linuxcnc --machine {0}`. Start `linuxcnc machine.ini` in this folder; "
      "it needs no "
      "display. Then `understudy drive PROGRAM --machine {0} --port "
      "'tcp://127.0.0.1:5007?family=linuxcnc&home=yes'`.\n\n"
      "linuxcncrsh listens on every network interface with a password that everybody knows: keep its port "
      "behind a "
      "firewall. LinuxCNC leaves `machine.var` in this folder; a later export goes to another.\n\n"
      "| file | contents | on a real machine |\n|---|---|---|\n"
      "| `machine.ini` | limits of struts and pose, kinematics | stays |\n"
      "| `machine.hal` | genhexkins, strut lengths, feeder, heater and fan | stays |\n"
      "| `understudy_*.ngc` | subroutines that the port calls | stay |\n"
      "| `pins.hal` | drives, emergency stop, heater, fan | is written anew: each line names a pin |\n\n"
      "| strut | steps per mm | at home [mm] | range [mm] | speed [mm/s] | acceleration [mm/s2] |\n"
      "|---|---|---|---|---|---|\n",
      f.settings.machine);
  text += each_strut(f, [](const HalAxis& a, std::size_t) {
    return fmt::format("| `{}` | {:.6g}{} | {:.6g} | {:.6g} .. {:.6g} | {:.4g} | {:.4g} |\n", a.name, a.scale,
                       a.assumed ? " (**assumed**)" : "", a.home, a.lower, a.upper, a.velocity,
                       a.acceleration);
  });
  return text +
         "\n| signal | meaning |\n|---|---|\n"
         "| `STRUT-command`, `STRUT-drive` | [mm] of a strut from home: command and position of its drive |\n"
         "| `STRUT-enable` | switches its drive on |\n"
         "| `STRUT-limit-switch`, `STRUT-home-switch` | switches |\n"
         "| `filament-command` | [mm], where the feeder shall be |\n"
         "| `nozzle-setpoint`, `nozzle-is-hot`, `fan-setpoint` | [deg C], TRUE at that temperature, 0..1 |\n"
         "| `emergency-stop-ok` | TRUE while the chain of emergency stops is closed; in series with "
         "`iocontrol.0.user-enable-out` |\n\n"
         "The machine must stand at home when LinuxCNC starts, or `zero.STRUT.offset` says where (the "
         "negative of "
         "the length). `home=yes` then takes the positions as they are.\n";
}

std::string move_file(const char* name, int blocks) {
  std::string text =
      fmt::format("o<{}> sub\n(X Y Z A B C, inverse time, filament mm, its speed mm/s, of {} block{})\n",
                  name, blocks, blocks == 1 ? "" : "s");
  for (int b = 0; b < blocks; ++b) {
    const int p = 9 * b;
    text += fmt::format("M67 E0 Q#{}\nM67 E1 Q#{}\nG93 G1 X#{} Y#{} Z#{} A#{} B#{} C#{} F#{}\n", p + 8, p + 9,
                        p + 1, p + 2, p + 3, p + 4, p + 5, p + 6, p + 7);
  }
  return text + fmt::format("o<{}> endsub\nM2\n", name);
}

constexpr const char* kFeedFile =
    "o<understudy_feed> sub\n(filament mm, its speed mm/s, seconds; the axes rest)\n"
    "M68 E1 Q#2\nM68 E0 Q#1\nG4 P#3\no<understudy_feed> endsub\nM2\n";
constexpr const char* kHeatFile =
    "o<understudy_heat> sub\n(degrees Celsius; waits until the nozzle is hot)\n"
    "M68 E2 Q#1\nM66 P0 L3 Q600\no100 if [#5399 LT 0]\n(ABORT, the nozzle does not become hot)\no100 endif\n"
    "o<understudy_heat> endsub\nM2\n";

}  // namespace

std::vector<HalFile> linuxcnc_files(const machine::MachineDescription& machine, const HalOptions& options) {
  if (machine.is_chain())
    throw InputError(machine.file.string() +
                     ": LinuxCNC's genhexkins is the kinematics of a hexapod, and this machine is none: "
                     "write one by understudy export hal");
  const Figures f{machine, hal_settings(machine, options), to_mm(machine.hexapod().geometry.deviation)};
  return {{"machine.ini", ini_file(f)},
          {"machine.hal", machine_file(f)},
          {"pins.hal", pins_file(f)},
          {"understudy_move.ngc", move_file("understudy_move", 1)},
          {"understudy_moves.ngc", move_file("understudy_moves", 2)},
          {"understudy_feed.ngc", kFeedFile},
          {"understudy_heat.ngc", kHeatFile},
          {"tool.tbl", ";\n"},
          {"README.md", readme(f)}};
}

}  // namespace understudy::drivers
