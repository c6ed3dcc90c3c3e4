#include "bench/plant/engine_comparison.h"

#include <cmath>

namespace understudy::sim {
namespace {

EngineDifference difference(const MotionTrace& engine, const MotionTrace& mujoco,
                            const CommandStream& stream) {
  const auto apart = distances(engine.tip_W, mujoco.tip_W);
  return {std::abs(peak(distances(engine.tip_W, stream.tip_W)) - peak(distances(mujoco.tip_W, stream.tip_W))),
          median(apart), peak(apart)};
}

}  // namespace

EngineComparison compare_engines(const machine::MachineDescription& machine, const ReferenceMotion& motion,
                                 double play, double timestep) {
  const CommandStream stream = command_stream(machine, motion, timestep);
  const AsBuilt built = built_with_play(machine, machine.is_chain() ? play / kArmReach : play);
  const int axes = machine.is_chain() ? built.chain.size() : kinematics::kStruts;
  MujocoOptions mujoco_options;
  BulletOptions bullet_options;
  QuasistaticOptions quasistatic_options;
  mujoco_options.timestep = bullet_options.timestep = quasistatic_options.timestep = timestep;
  const auto mujoco = run(*make_mujoco_plant(machine, built, mujoco_options), stream);
  const auto bullet = run(*make_bullet_plant(machine, built, bullet_options), stream);
  const auto quasistatic = run(*make_quasistatic_plant(machine, built, quasistatic_options), stream);
  const auto result = [&](const MotionTrace& trace) {
    return EngineResult{peak(distances(trace.tip_W, stream.tip_W)), load_flips(trace, timestep, axes)};
  };
  return {result(mujoco), result(bullet), difference(bullet, mujoco, stream),
          difference(quasistatic, mujoco, stream)};
}

}  // namespace understudy::sim
