#include "machine/library_versions.h"

namespace understudy::machine {

LibraryVersions library_versions() { return {{"urdfdom", loaded_version("liburdfdom_model", "unknown")}}; }

}  // namespace understudy::machine
