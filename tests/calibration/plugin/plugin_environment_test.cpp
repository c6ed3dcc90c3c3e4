#include "calibration/plugin/plugin_environment.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::calibration {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(PluginEnvironment, KeepsWhatProgramsAreFoundAndRunBy) {
  ::setenv("PYTHONPATH", "/opt/a:/opt/b=c", 1);
  ::setenv("LC_NUMERIC", "de_DE.UTF-8", 1);
  ::setenv("OMP_NUM_THREADS", "2", 1);
  const auto kept = plugin_environment();
  EXPECT_THAT(kept, Contains("PYTHONPATH=/opt/a:/opt/b=c"));
  EXPECT_THAT(kept, Contains("LC_NUMERIC=de_DE.UTF-8"));
  EXPECT_THAT(kept, Contains("OMP_NUM_THREADS=2"));
  EXPECT_THAT(kept, Contains(StartsWith("PATH=")));
}

TEST(PluginEnvironment, LeavesOutWhatOpensDoors) {
  for (const char* name : {"GITHUB_TOKEN", "AWS_SECRET_ACCESS_KEY", "SSH_AUTH_SOCK",
                           "DBUS_SESSION_BUS_ADDRESS", "PATH_TO_KEY", "HOMEBREW_TOKEN", "XLC_A"})
    ::setenv(name, "4711", 1);
  EXPECT_THAT(plugin_environment(), Each(Not(HasSubstr("4711"))));
}

}  // namespace
}  // namespace understudy::calibration
