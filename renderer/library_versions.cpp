#include "renderer/library_versions.h"

#include <regex>
#include <string>

#include "core/error.h"
#include "renderer/gl_context.h"

namespace understudy::renderer {
namespace {

void add(const char* library, const std::string& text, const char* pattern, LibraryVersions& to) {
  std::smatch found;
  if (std::regex_search(text, found, std::regex(pattern))) to[library] = found[1];
}

/// "4.5 (Core Profile) Mesa 22.3.6" and "llvmpipe (LLVM 15.0.6, 256 bits)".
LibraryVersions ask() {
  LibraryVersions versions;
  try {
    GlContext context;
    context.make_current();
    const auto text = [&](GLenum name) {
      return std::string(reinterpret_cast<const char*>(context.gl().GetString(name)));
    };
    add("Mesa", text(GL_VERSION), R"(Mesa (\S+))", versions);
    add("LLVM", text(GL_RENDERER), R"(LLVM ([^,)]+))", versions);
  } catch (const MachineError&) {
  }
  return versions;
}

}  // namespace

LibraryVersions library_versions() {
  static const LibraryVersions versions = ask();
  return versions;
}

}  // namespace understudy::renderer
