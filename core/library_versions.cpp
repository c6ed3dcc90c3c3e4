#include "core/library_versions.h"

#include <gnu/libc-version.h>
#include <link.h>

#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <tinyxml2.h>
#include <Eigen/Core>

namespace understudy {
namespace {
namespace fs = std::filesystem;

struct Search {
  std::string library, version;
};

/// A name in the table of loaded files is often a link; the file that it leads to carries the whole version.
int look_at(dl_phdr_info* info, std::size_t, void* data) {
  auto& search = *static_cast<Search*>(data);
  const std::string start = search.library + ".so.";
  if (!fs::path(info->dlpi_name).filename().string().starts_with(start)) return 0;
  std::error_code error;
  const std::string file = fs::canonical(info->dlpi_name, error).filename().string();
  if (error || !file.starts_with(start)) return 0;
  search.version = file.substr(start.size());
  return 1;
}

}  // namespace

LibraryVersions library_versions() {
  return {{"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"OpenSSL", OpenSSL_version(OPENSSL_VERSION_STRING)},
          {"fmt", loaded_version("libfmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000,
                                                       FMT_VERSION / 100 % 100, FMT_VERSION % 100))},
          {"glibc", gnu_get_libc_version()},
          {"tinyxml2",
           loaded_version("libtinyxml2", fmt::format("{}.{}.{}", TINYXML2_MAJOR_VERSION,
                                                     TINYXML2_MINOR_VERSION, TINYXML2_PATCH_VERSION))},
          {"yaml-cpp", loaded_version("libyaml-cpp", "unknown")}};
}

std::string loaded_version(const std::string& library, const std::string& otherwise) {
  Search search{library, otherwise};
  dl_iterate_phdr(look_at, &search);
  return search.version;
}

}  // namespace understudy
