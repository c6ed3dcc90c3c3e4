#include "studies/gap/gap_bench.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "control/program/rotary_words.h"
#include "core/error.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "geometry/box_mesh.h"
#include "machine/fixture_file.h"
#include "rehearsal/fixture.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::studies {

using toolpath::Step;
using toolpath::StepKind;

namespace {

constexpr double kFeed = 5e-3;          // [m/s]
constexpr double kFilament = 1.0 / 60;  // [m/m], of bead
constexpr double kStandoff = 2e-3;      // [m]
constexpr double kOften = 1.0 / 3;      // of the frames that are stale or lost
constexpr double kUnderHome = 10e-3;    // [m]
constexpr double kSlope = 0.015;        // [m/m], 1 sigma of the error's change along the path
constexpr double kError = 0.2e-3;       // [m], 1 sigma of the error at the start

/// A plate of 60 mm whose top passes through `p`, leaning towards the laser by `tilt`.
std::shared_ptr<const geometry::Mesh> plate(const Vec3& p, double tilt) {
  return geometry::box_mesh(Vec3(-30e-3, -30e-3, -5e-3), Vec3(30e-3, 30e-3, 0),
                            make_pose(exp_rotation(tilt * Vec3::UnitX()), p));
}

Step step_to(StepKind kind, const Pose& X_WT, int line, double filament = 0) {
  Step step;
  step.kind = kind;
  step.X_WT = X_WT;
  step.feed = kFeed;
  step.line = line;
  step.filament = filament;
  return step;
}

Pose along(Pose X_WT, double x, double z) {
  X_WT.translation() += X_WT.linear() * Vec3(x, 0, z);
  return X_WT;
}

toolpath::Program bead_program(const Pose& X_WT_S, double bead) {
  toolpath::Program program;
  program.file = "gap-benchmark";
  program.steps = {step_to(StepKind::travel, along(X_WT_S, 0, kStandoff), 1),
                   step_to(StepKind::move, X_WT_S, 2),
                   step_to(StepKind::print, along(X_WT_S, bead, 0), 3, kFilament * bead),
                   step_to(StepKind::move, along(X_WT_S, bead, kStandoff), 4)};
  return program;
}

}  // namespace

std::vector<GapSurface> gap_surfaces(const machine::MachineDescription& machine, const std::string& program,
                                     double bead) {
  std::vector<GapSurface> surfaces;
  const Pose X_WT_home = machine.X_WB * machine.X_BT_home;
  Pose X_WT_plate = X_WT_home;  // well below: the machine begins clear of it, whatever its error
  X_WT_plate.translation().z() -= kUnderHome;
  for (const double degrees : {0.0, 10.0, 20.0, 30.0}) {
    GapSurface surface;
    surface.name = degrees == 0 ? "flat" : "tilted " + std::to_string(static_cast<int>(degrees)) + " deg";
    surface.part = plate(X_WT_plate.translation(), from_deg(degrees));
    surface.X_WT_S = along(X_WT_plate, 0, machine.gap.aim);
    surface.program = bead_program(surface.X_WT_S, bead);
    surfaces.push_back(std::move(surface));
  }
  GapSurface bottle;
  bottle.name = "bottle 31 mm";
  bottle.part = rehearsal::read_fixture(machine::find_fixture("bottle"), machine);
  toolpath::GcodeOptions gcode;
  gcode.X_WT_home = X_WT_home;
  gcode.rotary = control::rotary_words(machine);
  bottle.program = toolpath::read_gcode(program, gcode);
  const auto first = std::find_if(bottle.program.steps.begin(), bottle.program.steps.end(),
                                  [](const Step& s) { return s.kind == StepKind::print; });
  if (first == bottle.program.steps.begin() || first == bottle.program.steps.end())
    throw InputError(program + ": it prints nothing after an approach");
  bottle.X_WT_S = std::prev(first)->X_WT;
  surfaces.push_back(std::move(bottle));
  return surfaces;
}

const std::vector<GapCondition>& gap_conditions() {
  static const std::vector<GapCondition> conditions{
      {"no speckle", true, false, 1, 1, FrameFault::none, true},
      {"speckle", true, true, 1, 1, FrameFault::none, true},
      {"ambient light, fivefold", true, true, 1, 5, FrameFault::none, true},
      {"laser at a quarter", true, true, 0.25, 1, FrameFault::none, true},
      {"laser at threefold: saturated", false, true, 3, 1, FrameFault::none, true},
      {"beam half hidden", false, true, 1, 1, FrameFault::occluded, true},
      {"a glowing thread, standing still", false, true, 1, 1, FrameFault::ghost, false},
      {"a third of the frames stale", false, true, 1, 1, FrameFault::stale, false},
      {"a third of the frames lost", false, true, 1, 1, FrameFault::lost, false}};
  return conditions;
}

namespace {

machine::MachineDescription lit(machine::MachineDescription machine, const GapCondition& condition) {
  machine.laser.peak_level *= condition.light;
  machine.microscope.ambient_level *= condition.ambient;
  return machine;
}

sim::MicroscopeOptions optics(const GapCondition& condition) {
  sim::MicroscopeOptions options;
  options.speckle = condition.speckle;
  return options;
}

}  // namespace

GapScene::GapScene(const machine::MachineDescription& machine, const GapSurface& on,
                   const GapCondition& under, Since since, std::uint64_t seed)
    : surface(on),
      condition(under),
      since_(since),
      lit_(lit(machine, under)),
      microscope_(lit_, on.part, seed, optics(under)),
      random_(seed, "gap benchmark " + on.name + " " + under.name) {
  if (since == Since::bead) calm_.emplace(machine, on.part, seed);
}

Image GapScene::expose(const Pose& X_WT_true, const Region& region, bool printing) {
  if (!disturbed(printing)) return calm_->expose(X_WT_true, region, frame_++);
  Image image = microscope_.expose(X_WT_true, region, frame_++);
  if (condition.mischief == FrameFault::occluded) occlude(image);
  if (condition.mischief == FrameFault::ghost) glow(image);
  if (condition.mischief == FrameFault::lost && random_.uniform() < kOften) image.pixels.clear();
  return image;
}

int GapScene::repeats(bool printing) {
  int repeats = 0;
  if (disturbed(printing) && condition.mischief == FrameFault::stale)
    while (random_.uniform() < kOften) ++repeats;
  return repeats;
}

/// A thread of plastic that hangs from the nozzle: on the sensor it stands still, over where the dot lies at
/// the aim.
void GapScene::occlude(Image& image) const {
  const auto at = microscope_.true_dot(surface.X_WT_S);
  if (!at) return;
  const double edge = at->x();
  const auto level = static_cast<std::uint8_t>(std::clamp(lit_.microscope.ambient_level, 0.0, 255.0));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (image.region.x + x > edge && image.region.x + x < edge + 30)
        image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
                     static_cast<std::size_t>(x)] = level;
}

/// A thread that lies in the beam and glows instead of the part, a little beside where the dot lies at the
/// aim and as wide as that; it flickers as speckle does (docs/reference.md#dot-and-gap: 0.30 to 0.46 px).
void GapScene::glow(Image& image) {
  constexpr double kBeside = 40e-6, kFlicker = 0.35;  // [m] of gap, [px]
  const auto at = microscope_.true_dot(along(surface.X_WT_S, 0, kBeside));
  Eigen::Matrix2d spread;
  const auto local = control::local_surface(*surface.part, surface.X_WT_S);
  if (!at || !control::predict_spread(lit_, local, lit_.gap.aim, spread)) return;
  const Eigen::Matrix2d inverse = spread.inverse();
  const Vec2 centre = *at + kFlicker * normal_vec2(random_);
  const double noise = 255 / lit_.microscope.full_well * lit_.microscope.read_noise;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Vec2 d = Vec2(image.region.x + x, image.region.y + y) - centre;
      const double level = lit_.microscope.ambient_level + noise * random_.normal() +
                           lit_.laser.peak_level * std::exp(-0.5 * d.dot(inverse * d));
      image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
                   static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
    }
}

double GapScene::true_gap(const Pose& X_WT_true) const {
  constexpr double kAbove = 5e-3;  // [m]: from outside the part, wherever the tip is
  const auto hit = surface.part->ray_hit(X_WT_true * Vec3(0, 0, kAbove), -tool_axis(X_WT_true), 0.1);
  return hit ? hit->distance - kAbove : std::nan("");
}

namespace {

/// The machine: a port whose axes obey, and the tip elsewhere.
class ErringMachine {
 public:
  ErringMachine(const machine::MachineDescription& machine, GapScene& scene, std::uint64_t seed)
      : machine_(machine),
        scene_(scene),
        mechanism_(machine.make_mechanism()),
        port_(options(), [this](auto& s, auto& r, auto& i) { return draw(s, r, i); }) {
    Random random(seed, "gap benchmark machine");
    error_ = kError * random.normal();
    slope_ = kSlope * random.normal();
    turn_ = 2e-3 * normal_vec3(random);
  }
  machine::LoopbackPort& port() { return port_; }

  Pose truth(const kinematics::AxisVector& axes) const {
    Pose X_BT;
    const auto n = static_cast<std::size_t>(mechanism_->axis_count());
    if (mechanism_->forward(std::span<const double>(axes.data(), n), machine_.X_BT_home, X_BT) !=
        kinematics::SolveStatus::ok)
      throw MachineError("the benchmark's axes belong to no pose");
    Pose X_WT = machine_.X_WB * X_BT;
    const double way = (X_WT.translation() - scene_.surface.X_WT_S.translation()).head<2>().norm();
    X_WT.translation() += (error_ + slope_ * way) * tool_axis(X_WT);
    X_WT.linear() = exp_rotation(turn_) * X_WT.linear();
    return X_WT;
  }

 private:
  machine::LoopbackPort::Options options() const {
    machine::LoopbackPort::Options o;
    o.axis_count = mechanism_->axis_count();
    const auto n = static_cast<std::size_t>(o.axis_count);
    if (mechanism_->inverse(machine_.X_BT_home, {}, std::span(o.start).first(n)) !=
        kinematics::SolveStatus::ok)
      throw MachineError("the machine cannot reach its home");
    o.frame_time = machine_.microscope.exposure + machine_.microscope.transfer;
    return o;
  }
  bool draw(const machine::AxisState& state, const Region& region, Image& image) {
    const bool printing = !port_.history().empty() && port_.history().back().filament > 0;
    image = scene_.expose(truth(state.position), region, printing);
    port_.repeat_frames(scene_.repeats(printing));
    return !image.pixels.empty();
  }

  const machine::MachineDescription& machine_;
  GapScene& scene_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  double error_ = 0, slope_ = 0;
  Vec3 turn_{0, 0, 0};
  machine::LoopbackPort port_;
};

}  // namespace

toolpath::Program until_bead(const toolpath::Program& program) {
  constexpr double kShortest = 1e-5;  // [m]; without a bead there is nothing to approach for
  toolpath::Program short_one = program;
  const auto first = std::find_if(short_one.steps.begin(), short_one.steps.end(),
                                  [](const Step& s) { return s.kind == StepKind::print; });
  Step touch = *first;
  touch.X_WT = std::prev(first)->X_WT;
  touch.filament *= kShortest / (first->X_WT.translation() - touch.X_WT.translation()).norm();
  touch.X_WT.translation() += kShortest * touch.X_WT.linear().col(0);
  touch.rotary.reset();
  short_one.steps.erase(first, short_one.steps.end());
  short_one.steps.push_back(touch);
  return short_one;
}

GapTrial run_gap_trial(const machine::MachineDescription& machine, GapScene& scene, control::GapControl mode,
                       std::uint64_t seed) {
  ErringMachine erring(machine, scene, seed);
  control::PrintOptions options;
  options.gap_control = mode;
  options.part = scene.surface.part.get();
  const bool follows = mode == control::GapControl::continuous;
  GapTrial trial;
  trial.result = control::print(follows ? scene.surface.program : until_bead(scene.surface.program), machine,
                                erring.port(), options);
  constexpr std::size_t kEvery = 5;  // cycles: 25 um of the path
  trial.gap_min_mm = HUGE_VAL;
  double filament = 0;
  const auto& history = erring.port().history();
  for (std::size_t i = 0; i < history.size(); i += kEvery) {
    const double gap = to_mm(scene.true_gap(erring.truth(history[i].position)));
    if (std::isfinite(gap)) trial.gap_min_mm = std::min(trial.gap_min_mm, gap);
    if (history[i].filament > filament && std::isfinite(gap)) trial.bead_gaps_mm.push_back(gap);
    filament = std::max(filament, history[i].filament);
  }
  trial.last_gap_mm = to_mm(scene.true_gap(erring.truth(erring.port().state().position)));
  return trial;
}

}  // namespace understudy::studies
