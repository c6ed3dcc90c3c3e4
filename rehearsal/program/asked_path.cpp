#include "rehearsal/program/asked_path.h"

#include <filesystem>
#include <system_error>

#include "core/digest.h"
#include "core/file/read_file.h"
#include "rehearsal/program/program_reading.h"
#include "toolpath/gcode/rewrite/gcode_rewrite.h"

namespace understudy::rehearsal {

namespace fs = std::filesystem;

std::string original_of(const std::string& program) {
  std::error_code none;
  if (!fs::is_regular_file(program, none)) return {};
  const auto origin = toolpath::origin_of(read_file(program));
  if (!origin) return {};
  for (const fs::path& path :
       {fs::path(origin->file), fs::path(program).parent_path() / fs::path(origin->file).filename()})
    if (fs::is_regular_file(path, none) && sha256_hex(read_file(path)) == origin->sha256)
      return path.string();
  return {};
}

std::shared_ptr<const toolpath::RewrittenPath> asked_path(const RehearsalRequest& request,
                                                          const machine::MachineDescription& machine) {
  RehearsalRequest original = request;
  original.program = request.program.empty() ? "" : original_of(request.program);
  if (original.program.empty()) return nullptr;
  const toolpath::Program rewritten = read_program(request, machine).program;
  return std::make_shared<toolpath::RewrittenPath>(read_program(original, machine).program, rewritten,
                                                   read_file(request.program),
                                                   machine.X_WB * machine.X_BT_home);
}

}  // namespace understudy::rehearsal
