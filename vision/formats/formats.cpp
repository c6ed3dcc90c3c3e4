#include "vision/formats/formats.h"

#include <dlfcn.h>

#include <array>
#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "core/version.h"

namespace understudy::vision {
namespace {
namespace fs = std::filesystem;

constexpr const char* kModule = "understudy-formats.so";

/// Of the shared object that this code is part of; of a program as the first word of its command names it.
fs::path object_folder() {
  Dl_info own{};
  if (::dladdr(reinterpret_cast<const void*>(&object_folder), &own) == 0 || own.dli_fname == nullptr)
    return {};
  return fs::path(own.dli_fname).parent_path();
}

fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

const Formats* load() {
  const fs::path file = formats_file();
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) throw MachineError(std::string("cannot load ") + ::dlerror());
  using Entry = const Formats* (*)(const char* version);
  const auto entry = reinterpret_cast<Entry>(::dlsym(module, "understudy_formats"));
  const Formats* formats = entry ? entry(kVersion) : nullptr;
  if (!formats)
    throw MachineError(file.string() + " is not of version " + kVersion + ": install Understudy again");
  return formats;
}

}  // namespace

fs::path formats_file() {
  // The Python module's in a wheel and in PREFIX/lib/python3/dist-packages, the program's in PREFIX/bin.
  const std::array<fs::path, 5> folders{
      object_folder() / "lib/understudy", object_folder() / "../../../understudy",
      program_folder() / "../lib/understudy", UNDERSTUDY_MODULES_BUILT, UNDERSTUDY_MODULES_INSTALLED};
  std::error_code error;
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / kModule, error)) return fs::canonical(folder / kModule);
  throw MachineError(
      std::string(kModule) +
      ", which reads pictures other than PNG and handles videos, is missing; it belongs into " +
      folders[2].lexically_normal().string() + ": install Understudy again");
}

const Formats& formats() {
  static const Formats* loaded = load();  // never unloaded: libraries of formats keep threads of their own
  return *loaded;
}

}  // namespace understudy::vision
