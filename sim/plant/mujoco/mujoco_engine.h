// MuJoCo's model and data with an owner, and its global error hooks tamed. Private to this room.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

namespace understudy::sim {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, FreeModel>;
using DataPointer = std::unique_ptr<mjData, FreeData>;

/// Compiles MJCF from memory. Throws MachineError with the compiler's message.
ModelPointer load_model(const std::string& mjcf);
DataPointer make_data(const mjModel& model);

/// mj_step. Throws MachineError, naming the time, on any warning of the engine: it resets the state in
/// silence when numbers go bad.
void checked_step(const mjModel& model, mjData& data);

/// Index of a named object. Throws MachineError when the model has none.
int find_id(const mjModel& model, mjtObj type, const std::string& name);

}  // namespace understudy::sim
