// `doctor` against what Debian's package database says of the installed libraries.
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using Versions = std::map<std::string, std::string>;

const Versions kPackagesOfTheController{
    {"Boost", "libboost-math-dev"},  {"CLI11", "libcli11-dev"},     {"Clipper", "libpolyclipping-dev"},
    {"Eigen", "libeigen3-dev"},      {"OpenCV", "libopencv-dev"},   {"OpenSSL", "libssl-dev"},
    {"assimp", "libassimp-dev"},     {"fmt", "libfmt-dev"},         {"glibc", "libc6"},
    {"libpng", "libpng-dev"},        {"lib2geom", "lib2geom-dev"},  {"nlohmann-json", "nlohmann-json3-dev"},
    {"tinyxml2", "libtinyxml2-dev"}, {"urdfdom", "liburdfdom-dev"}, {"yaml-cpp", "libyaml-cpp-dev"}};
const Versions kPackagesOfTheTwin{{"Bullet", "libbullet-dev"}, {"FCL", "libfcl-dev"},
                                  {"LLVM", "libllvm15"},       {"Mesa", "libosmesa6-dev"},
                                  {"MuJoCo", "libmujoco-dev"}, {"tinygltf", "libtinygltf-dev"},
                                  {"HDF5", "libhdf5-dev"},     {"cpp-httplib", "libcpp-httplib-dev"},
                                  {"zlib", "zlib1g-dev"}};

Versions printed_versions(const std::string& text) {
  Versions versions;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, name, version;
    if (words >> word >> name >> version && word == "lib") versions[name] = version;
  }
  return versions;
}

/// Without Debian's epoch: "22.3.6-1+deb12u1".
std::string installed_version(const std::string& package) {
  const std::string command = "dpkg-query -W -f '${Version}\n' " + package + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 200> line{};
  const bool read = std::fgets(line.data(), line.size(), pipe) != nullptr;
  ::pclose(pipe);
  const std::string version = read ? line.data() : "";
  return version.substr(version.find(':') + 1);
}

TEST(Doctor, TellsTheVersionOfEveryLibraryThatIsInstalled) {
  const Outcome outcome = understudy("doctor");
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  Versions packages = kPackagesOfTheController;
  if (outcome.out.find("left out of this build") == std::string::npos)
    packages.insert(kPackagesOfTheTwin.begin(), kPackagesOfTheTwin.end());
  Versions versions = printed_versions(outcome.out);
  for (const auto& [library, package] : packages) {
    ASSERT_TRUE(versions.contains(library)) << library << '\n' << outcome.out;
    EXPECT_GE(versions[library].size(), 3u) << library;
    // assimp 5.2.5 was released with the number 5.2.4 in it.
    if (library == "assimp") versions[library] = versions[library].substr(0, versions[library].rfind('.'));
    EXPECT_THAT(installed_version(package), testing::StartsWith(versions[library])) << library;
    versions.erase(library);
  }
  // What npm bundles into the page: all of it or, in a build without npm, nothing.
  std::ifstream file(std::string(UNDERSTUDY_SOURCE_DIR) + "/web/package.json");
  const std::string wanted((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const bool bundled = versions.contains("three");
  for (const char* package : {"fflate", "three", "uplot"}) {
    EXPECT_EQ(versions.contains(package), bundled) << package;
    EXPECT_THAT(wanted, testing::HasSubstr('"' + std::string(package) + "\": \"" + versions[package]))
        << package;
    versions.erase(package);
  }
  EXPECT_THAT(versions, testing::IsEmpty());
}

}  // namespace
}  // namespace understudy::cli_test
