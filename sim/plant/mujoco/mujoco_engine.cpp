#include "sim/plant/mujoco/mujoco_engine.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <mutex>

#include "core/error.h"

namespace understudy::sim {
namespace {

constexpr const char* kFileName = "machine.xml";

// MuJoCo would write MUJOCO_LOG.TXT into the working folder and exit the process. Its engine is C compiled
// with unwind tables, so an exception may pass through it.
void throw_engine_error(const char* message) {
  throw MachineError(fmt::format("engine failure: {}", message));
}

// Warnings are counted in mjData, where checked_step reads them.
void keep_quiet(const char*) {}

void install_hooks() {
  static std::once_flag once;
  std::call_once(once, [] {
    mju_user_error = throw_engine_error;
    mju_user_warning = keep_quiet;
  });
}

const char* describe(int warning) {
  switch (warning) {
    case mjWARN_INERTIA:
      return "the mass matrix is close to singular";
    case mjWARN_CONTACTFULL:
      return "too many contacts";
    case mjWARN_CNSTRFULL:
      return "too many constraints";
    case mjWARN_BADQPOS:
      return "a position is not finite or beyond 1e10";
    case mjWARN_BADQVEL:
      return "a velocity is not finite or beyond 1e10";
    case mjWARN_BADQACC:
      return "an acceleration is not finite or beyond 1e10";
    default:
      return "the engine warned";
  }
}

}  // namespace

ModelPointer load_model(const std::string& mjcf) {
  install_hooks();
  static std::mutex compiler;  // the parser keeps global state
  const std::lock_guard lock(compiler);
  const auto files = std::make_unique<mjVFS>();  // 2 MB: too large for the stack
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), kFileName, static_cast<int>(mjcf.size())) != 0)
    throw MachineError("engine failure: no memory for the model");
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kFileName)], mjcf.data(), mjcf.size());
  std::array<char, 1000> message{};
  ModelPointer model(mj_loadXML(kFileName, files.get(), message.data(), static_cast<int>(message.size())));
  mj_deleteVFS(files.get());
  if (!model) throw MachineError(fmt::format("engine failure: {}", message.data()));
  return model;
}

DataPointer make_data(const mjModel& model) {
  DataPointer data(mj_makeData(&model));
  if (!data) throw MachineError("engine failure: no memory for the state");
  return data;
}

void checked_step(const mjModel& model, mjData& data) {
  const double time = data.time;
  mj_step(&model, &data);
  for (int warning = 0; warning < mjNWARNING; ++warning)
    if (data.warning[warning].number > 0)
      throw MachineError(fmt::format("engine failure at {:.4f} s: {}", time, describe(warning)));
}

int find_id(const mjModel& model, mjtObj type, const std::string& name) {
  const int id = mj_name2id(&model, type, name.c_str());
  if (id < 0) throw MachineError(fmt::format("engine failure: the model has no \"{}\"", name));
  return id;
}

}  // namespace understudy::sim
