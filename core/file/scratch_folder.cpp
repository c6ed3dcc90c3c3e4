#include "core/file/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy {
namespace fs = std::filesystem;
namespace {

fs::path make_folder(const std::string& purpose) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) throw MachineError(fmt::format("there is no folder for temporary files: {}", error.message()));
  std::string name = (parent / ("understudy-" + purpose + "-XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr)
    throw MachineError(fmt::format("cannot make a folder in {}: {}", parent.string(),
                                   std::generic_category().message(errno)));
  return name;
}

}  // namespace

ScratchFolder::ScratchFolder(const std::string& purpose) : path_(make_folder(purpose)), goes_(path_) {}

}  // namespace understudy
