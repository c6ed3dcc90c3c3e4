#include "cli/plain_processor.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/error.h"

namespace understudy::cli {
namespace {

struct Setting {
  const char *name, *value;
};
// Sines, exponentials and their like without fused multiplication; shaders by what each processor of 64 bits
// has.
constexpr Setting kSettings[] = {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4"},
                                 {"GALLIUM_OVERRIDE_CPU_CAPS", "sse2"},
                                 {"LP_NATIVE_VECTOR_WIDTH", "128"}};

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

void restart_on_plain_instructions(char** argv) {
  if (variable("UNDERSTUDY_SIMD") != "scalar") return;
  bool as_asked = true;
  for (const auto& [name, value] : kSettings) {
    const std::string old = variable(name);
    if (old.ends_with(value)) continue;
    as_asked = false;
    // The C library's variable is a list; of two settings of one name the last holds.
    const bool list = name == std::string("GLIBC_TUNABLES") && !old.empty();
    ::setenv(name, list ? (old + ":" + value).c_str() : value, 1);
  }
  if (as_asked) return;
  ::execv("/proc/self/exe", argv);
  throw MachineError(std::string("UNDERSTUDY_SIMD=scalar: cannot start the program anew: ") +
                     std::strerror(errno));
}

}  // namespace understudy::cli
