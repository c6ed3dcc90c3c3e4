#include "drivers/hal/hal_files.h"

#include <functional>

#include <fmt/format.h>

#include "drivers/hal/hal_load_encoders.h"

namespace understudy::drivers {
namespace {

constexpr int kStreamDepth = 4096;  // rows: the port keeps far fewer under way
constexpr int kRecordDepth = 8192;  // rows that an onlooker may be late by

using OfAxis = std::function<std::string(const HalAxis&, std::size_t)>;

std::string each(const HalSettings& s, const OfAxis& text) {
  std::string all;
  for (std::size_t i = 0; i < s.axes.size(); ++i) all += text(s.axes[i], i);
  return all;
}

std::string names(const HalSettings& s, const std::string& prefix) {
  std::string list = each(s, [&](const HalAxis& a, std::size_t i) {
    return fmt::format("{}{}.{}", i == 0 ? "" : ",", prefix, a.name);
  });
  return list;
}

std::string repeated(const HalSettings& s, const char* type) {
  return each(s, [&](const HalAxis&, std::size_t) { return std::string(type); });
}

std::string header(const HalSettings& s, const char* what) {
  return fmt::format("# {}: {}\n# Written by `understudy export hal`; units are mm and degrees.\n", s.machine,
                     what);
}

std::string components(const HalSettings& s) {
  const std::size_t n = s.axes.size();
  std::string text = fmt::format(
      "loadrt threads name1=base period1={} fp1=0 name2=servo period2={:.0f}\n"
      "# Setpoints come in by the streamer, one row a servo period: axes, row number, reset, nozzle, fan.\n"
      "loadrt streamer depth={} cfg={}\n"
      "# Samplers: 0 what the port reads back; 1 the setpoints as received; 2 steps made, and the state;\n"
      "# 3 the setpoints after their limits.\n"
      "loadrt sampler depth={},{},{},{} cfg={},{},{},{}\n",
      s.options.base_period_us * 1000, s.cycle * 1e9, kStreamDepth, stream_columns(s), kStreamDepth,
      kRecordDepth, kRecordDepth, kRecordDepth, sample_columns(s), repeated(s, "f") + "sb",
      repeated(s, "s") + "sbbb", repeated(s, "f") + "s");
  text += fmt::format(
      "loadrt limit3 names={}\nloadrt mux2 names={},heater.gate,fan.gate\nloadrt offset names={}{}\n"
      "loadrt sum2 names={}\nloadrt wcomp names={}\n",
      names(s, "limit"), names(s, "acceleration"), names(s, "zero"), load_encoder_components(s),
      names(s, "error"), names(s, "following"));
  text += fmt::format(
      "loadrt timedelay names=watchdog,brake\n"
      "loadrt estop_latch names=latch\n"
      "loadrt not names=moving-on,lost,drives-off\n"
      "loadrt logic names=all-following,any-limit,any-fault,on-path,streaming "
      "personality=0x{:x},0x{:x},0x204,0x102,0x202\n\n",
      0x100 + n, 0x200 + n);
  return text;
}

std::string functions(const HalSettings& s) {
  std::string text =
      "# One servo period: read the drives, take a row, look for faults, limit, command.\n"
      "addf streamer.0 servo\naddf watchdog servo\n";
  const auto add = [&](const char* prefix, const char* suffix) {
    text += each(s, [&](const HalAxis& a, std::size_t) {
      return fmt::format("addf {}.{}{} servo\n", prefix, a.name, suffix);
    });
  };
  add("zero", ".update-feedback");
  text += load_encoder_functions(s);
  text += "addf moving-on servo\naddf on-path servo\n";
  add("acceleration", "");
  add("limit", "");
  add("error", "");
  add("following", "");
  text +=
      "addf all-following servo\naddf lost servo\naddf any-limit servo\naddf any-fault servo\naddf latch "
      "servo\n"
      "addf brake servo\naddf drives-off servo\naddf streaming servo\naddf heater.gate servo\naddf fan.gate "
      "servo\n";
  add("zero", ".update-output");
  return text + "\n";
}

std::string axis_nets(const HalSettings& s) {
  return each(s, [&](const HalAxis& a, std::size_t i) {
    std::string text = fmt::format(
        "net {0}-planned streamer.0.pin.{1} => limit.{0}.in sampler.1.pin.{1}\n"
        "setp limit.{0}.maxv {2:.9g}\n"
        "setp acceleration.{0}.in0 {3:.9g}\n"
        "setp acceleration.{0}.in1 {4:.9g}\n"
        "net {0}-maxa acceleration.{0}.out => limit.{0}.maxa\n",
        a.name, i, a.velocity, a.acceleration, a.jump);
    if (a.lower > -1e20) text += fmt::format("setp limit.{}.min {:.9g}\n", a.name, a.lower);
    if (a.upper < 1e20) text += fmt::format("setp limit.{}.max {:.9g}\n", a.name, a.upper);
    return text + fmt::format(
                      "net {0}-limited limit.{0}.out => zero.{0}.in error.{0}.in0 sampler.3.pin.{1}\n"
                      "setp zero.{0}.offset {2:.9g}\n"
                      "net {0}-command zero.{0}.out\n"
                      "net {0}-drive => zero.{0}.fb-in\n"
                      "net {0}-feedback zero.{0}.fb-out => error.{0}.in1 sampler.0.pin.{1}\n"
                      "setp error.{0}.gain1 -1\n"
                      "net {0}-error error.{0}.out => following.{0}.in\n"
                      "setp following.{0}.min {3:.9g}\n"
                      "setp following.{0}.max {4:.9g}\n"
                      "net {0}-follows following.{0}.out => all-following.in-{1:02}\n"
                      "net {0}-counts => sampler.2.pin.{1}\n"
                      "net {0}-limit-switch => any-limit.in-{1:02}\n"
                      "newsig {0}-home-switch bit\n\n",
                      a.name, i, -a.home, -a.following, a.following);
  });
}

std::string state_nets(const HalSettings& s) {
  const std::size_t n = s.axes.size();
  return fmt::format(
             "# The machine stops when no setpoint has come for {0:.0f} ms, whatever the reason.\n"
             "net starved streamer.0.empty => watchdog.in moving-on.in sampler.2.pin.{2}\n"
             "setp watchdog.on-delay {1:.9g}\n"
             "setp watchdog.off-delay 0\n"
             "net watchdog-bit watchdog.out => any-fault.in-00 sampler.0.pin.{3}\n"
             "net limit-tripped any-limit.or => any-fault.in-01 sampler.0.pin.{4}\n"
             "net following all-following.and => lost.in sampler.0.pin.{5}\n"
             "net following-lost lost.out => any-fault.in-02\n"
             "net software-stop => any-fault.in-03\n"
             "net fault any-fault.or => latch.fault-in\n"
             "net emergency-stop-ok => latch.ok-in sampler.0.pin.{6}\n"
             "net reset streamer.0.pin.{7} => latch.reset\n"
             "net machine-on latch.ok-out => brake.in on-path.in-00 streaming.in-00 heater.gate.sel "
             "fan.gate.sel "
             "sampler.0.pin.{8} sampler.1.pin.{2} sampler.2.pin.{9}\n"
             "net charge-pump latch.watchdog\n\n",
             s.options.watchdog * 1e3, s.options.watchdog, n + 1, n + 5, n + 6, n + 4, n + 7, n + 1, n + 2,
             n + 2) +
         fmt::format(
             "# A stop brakes first, in {0:.0f} ms, with the setpoint held; then the drives go off.\n"
             "setp brake.on-delay 0\n"
             "setp brake.off-delay {1:.9g}\n"
             "net drives-on brake.out => drives-off.in sampler.0.pin.{2} sampler.2.pin.{3}\n"
             "net drives-idle drives-off.out => streaming.in-01{4}\n"
             "net streaming-on streaming.or => streamer.0.enable\n"
             "# While setpoints come, a corner may jump; otherwise axes brake as their drives can.\n"
             "net rows-come moving-on.out => on-path.in-01\n"
             "net along-path on-path.and{5}\n\n",
             s.brake_time * 1e3, s.brake_time, n + 3, n + 3,
             each(s, [](const HalAxis& a, std::size_t) { return fmt::format(" limit.{}.load", a.name); }),
             each(s, [](const HalAxis& a,
                        std::size_t) { return fmt::format(" acceleration.{}.sel", a.name); })) +
         fmt::format(
             "# Heater [deg C] and fan [0..1]: off with the machine.\n"
             "net nozzle-planned streamer.0.pin.{0} => heater.gate.in1\n"
             "net nozzle-setpoint heater.gate.out\n"
             "net fan-planned streamer.0.pin.{1} => fan.gate.in1\n"
             "net fan-setpoint fan.gate.out\n"
             "newsig probe bit\n\n"
             "net row streamer.0.pin.{2} => sampler.0.pin.{2} sampler.1.pin.{2} sampler.3.pin.{2}\n"
             "net underruns streamer.0.underruns => sampler.0.pin.{3}\n"
             "net depth streamer.0.curr-depth => sampler.2.pin.{2}\n\n",
             n + 2, n + 3, n, n + 1);
}

std::string machine_file(const HalSettings& s) {
  return header(s, "setpoints to step generators, and what watches them") +
         "# halrun -I -f machine.hal, in this folder. README.md says what a real machine changes: not this "
         "file.\n\n" +
         components(s) + functions(s) + axis_nets(s) + state_nets(s) +
         load_encoder_nets(s, s.axes.size() + kStateColumns) +
         "source steps.hal\n"
         "addf sampler.0 servo\naddf sampler.1 servo\naddf sampler.2 servo\naddf sampler.3 servo\n"
         "source pins.hal\n"
         "start\n" +
         fmt::format(
             "# How a port knows that this is the machine that it drives, and that all of it is loaded.\n"
             "newsig understudy-{} bit\n",
             s.fingerprint);
}

std::string steps_file(const HalSettings& s) {
  std::string text =
      header(s, "step generators in software") +
      "# A board with step generators of its own takes the place of this file (README.md).\n\n" +
      "loadrt stepgen step_type=" +
      each(s, [](const HalAxis&, std::size_t i) { return std::string(i == 0 ? "0" : ",0"); }) +
      " ctrl_type=" +
      each(s, [](const HalAxis&, std::size_t i) { return std::string(i == 0 ? "p" : ",p"); }) +
      "\naddf stepgen.make-pulses base\naddf stepgen.capture-position servo 1\n"
      "addf stepgen.update-freq servo\n\n";
  return text + each(s, [&](const HalAxis& a, std::size_t i) {
           return fmt::format(
               "setp stepgen.{1}.position-scale {2:.9g}{5}\n"
               "setp stepgen.{1}.maxvel {3:.9g}\n"
               "setp stepgen.{1}.maxaccel {4:.9g}\n"
               "setp stepgen.{1}.steplen 1\n"
               "setp stepgen.{1}.stepspace 0\n"
               "setp stepgen.{1}.dirsetup 1\n"
               "setp stepgen.{1}.dirhold 1\n"
               "net {0}-command => stepgen.{1}.position-cmd\n"
               "net {0}-drive <= stepgen.{1}.position-fb\n"
               "net {0}-counts <= stepgen.{1}.counts\n"
               "net drives-on => stepgen.{1}.enable\n"
               "net {0}-step <= stepgen.{1}.step\n"
               "net {0}-direction <= stepgen.{1}.dir\n\n",
               a.name, i, a.scale, 1.1 * a.velocity, 1.1 * a.jump,
               a.assumed ? "  # assumed: the machine file has no drive for it" : "");
         });
}

std::string pins_file(const HalSettings& s) {
  const std::string first = s.axes.front().name;
  return header(s, "switches, heater, fan and probe: simulated") +
         fmt::format(
             "# A real machine replaces the lines below by its inputs and outputs, for instance\n"
             "#   net emergency-stop-ok <= parport.0.pin-10-in\n"
             "#   net {0}-limit-switch <= parport.0.pin-11-in\n"
             "#   net {0}-home-switch <= parport.0.pin-12-in\n"
             "#   net {0}-step => parport.0.pin-02-out\n"
             "#   net {0}-direction => parport.0.pin-03-out\n"
             "#   net drives-on => parport.0.pin-14-out\n"
             "#   net charge-pump => parport.0.pin-17-out\n"
             "#   net probe <= parport.0.pin-13-in\n"
             "#   net nozzle-setpoint => the temperature controller's setpoint [deg C], 0: off\n"
             "#   net fan-setpoint => pwmgen.0.value\n"
             "sets emergency-stop-ok 1\n",
             first) +
         simulated_load_encoders(s);
}

std::string axis_table(const HalSettings& s) {
  std::string text =
      "| axis | steps per unit | at HAL's start it stands at | range | speed | braking | following error |\n"
      "|---|---|---|---|---|---|---|\n";
  return text + each(s, [](const HalAxis& a, std::size_t) {
           const char* unit = a.angle ? "deg" : "mm";
           const auto end = [](double v) { return std::abs(v) < 1e20 ? fmt::format("{:.6g}", v) : "none"; };
           return fmt::format(
               "| `{}` [{}] | {:.6g}{} | {:.6g} | {} .. {} | {:.4g}/s | {:.4g}/s2 | {:.3g} |\n", a.name, unit,
               a.scale, a.assumed ? " (**assumed**)" : "", a.home, end(a.lower), end(a.upper), a.velocity,
               a.acceleration, a.following);
         });
}

std::string readme(const HalSettings& s) {
  std::string text = fmt::format(
      "# {0} on LinuxCNC's HAL\n\n"
      "Written by `understudy export hal --machine {0}`. `halrun -I -f machine.hal`, started in this folder, "
      "loads it; "
      "`understudy drive PROGRAM --machine {0} --port hal://THIS_FOLDER` starts it by itself, and "
      "`--port hal://` takes one that runs.\n\n"
      "| file | contents | on a real machine |\n|---|---|---|\n"
      "| `machine.hal` | streamer, limits, zeros, following error, watchdog, emergency-stop latch, samplers "
      "| stays |\n"
      "| `steps.hal` | step generators in software | stays, or gives way to the board's own generators |\n"
      "| `pins.hal` | switches, heater, fan, probe | is written anew: each line names a pin |\n\n",
      s.machine);
  text += "## Axes\n\n" + axis_table(s) +
          "\n**Assumed** figures are not in the machine file: correct them in `steps.hal` before anything "
          "moves.\n\n";
  const auto slow = too_fast_for_software(s);
  for (const std::string& line : slow) text += "- " + line + "\n";
  if (!slow.empty()) text += "\n";
  text += fmt::format(
      "## Signals that a machine connects\n\n"
      "| signal | meaning |\n|---|---|\n"
      "| `emergency-stop-ok` | TRUE while the chain of emergency stops is closed; FALSE stops the machine |\n"
      "| `AXIS-limit-switch` | TRUE stops the machine |\n"
      "| `AXIS-home-switch`, `probe` | read by whoever homes the machine |\n"
      "| `AXIS-step`, `AXIS-direction` | of the software step generators |\n"
      "| `AXIS-command`, `AXIS-drive` | command and position of other step generators, counted from where "
      "the axis stands when HAL starts |\n"
      "{}"
      "| `drives-on` | enables the drives |\n"
      "| `charge-pump` | toggles while the machine is on, for a relay that drops when HAL dies |\n"
      "| `nozzle-setpoint`, `fan-setpoint` | [deg C] and 0..1; 0 while the machine is off |\n\n"
      "The axes must stand at the positions of the table when HAL starts; after homing, `setp "
      "zero.AXIS.offset` says where (the negative of the position).\n\n"
      "## Stops\n\n"
      "No setpoint for {:.0f} ms, a limit switch, a following error or an open emergency-stop chain opens "
      "the latch: heater and fan go off, the axes brake for {:.0f} ms, the drives go off. "
      "Only a port that sends setpoints again can close it.\n\n"
      "## Real time\n\n"
      "Without a real-time kernel HAL says `Note: Using POSIX non-realtime`, and everything but the step "
      "pulses' timing is as it will be. Install a "
      "PREEMPT_RT kernel (`linux-image-rt-amd64`), measure with `latency-histogram`, and choose "
      "`--base-period` above the worst latency; a board with step generators in hardware needs "
      "the servo thread alone.\n",
      load_encoder_signals(s), s.options.watchdog * 1e3, s.brake_time * 1e3);
  return text;
}

}  // namespace

std::string stream_columns(const HalSettings& s) { return repeated(s, "f") + "sbff"; }
std::string sample_columns(const HalSettings& s) {
  return repeated(s, "f") + "ssbbbbbb" + std::string(s.load_encoders ? s.machine_axes : 0, 'f');
}

std::vector<HalFile> hal_files(const HalSettings& settings) {
  return {{"machine.hal", machine_file(settings)},
          {"steps.hal", steps_file(settings)},
          {"pins.hal", pins_file(settings)},
          {"README.md", readme(settings)}};
}

}  // namespace understudy::drivers
