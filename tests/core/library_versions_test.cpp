#include "core/library_versions.h"

#include <filesystem>
#include <fstream>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy {
namespace {

/// The file of a library in this process, as the kernel lists it: the whole name, no link.
std::string mapped_file(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (const std::size_t at = line.find("/" + library + ".so."); at != std::string::npos)
      return line.substr(at + 1);
  return "";
}

TEST(LibraryVersions, AreThoseOfTheFilesThatAreLoaded) {
  for (const auto& [name, library] : {std::pair("yaml-cpp", "libyaml-cpp"), std::pair("fmt", "libfmt")}) {
    const std::string file = mapped_file(library);
    ASSERT_NE(file, "") << library;
    EXPECT_EQ(std::string(library) + ".so." + library_versions().at(name), file);
  }
}

TEST(LibraryVersions, AreNumbers) {
  const LibraryVersions versions = library_versions();
  EXPECT_EQ(versions.size(), 6u);
  for (const auto& [name, version] : versions)
    EXPECT_TRUE(std::regex_match(version, std::regex(R"(\d+\.\d+(\.\d+)?)"))) << name << ' ' << version;
}

TEST(LibraryVersions, OfAFileThatIsNotLoadedAreWhatTheCallerSays) {
  EXPECT_EQ(loaded_version("libyaml", "1.2"), "1.2");  // the beginning of a name is no name
  EXPECT_EQ(loaded_version("libnone", "unknown"), "unknown");
}

}  // namespace
}  // namespace understudy
