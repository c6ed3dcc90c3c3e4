#include "calibration/plugin/box_words.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;

/// An entry of /tmp itself, gone with the object.
class Entry {
 public:
  explicit Entry(const std::string& name)
      : path_("/tmp/understudy-entry-" + std::to_string(::getpid()) + name) {
    fs::create_directories(path_ / "deep");
    std::ofstream(path_ / "deep/mine.py") << "pass\n";
  }
  ~Entry() { fs::remove_all(path_); }
  std::string path() const { return path_.string(); }
  std::string name() const { return path_.filename().string(); }

 private:
  fs::path path_;
};

TEST(BoxWords, WhatACommandNamesInTheTemporaryFolderIsShown) {
  const Entry entry("a"), other("b");
  fs::current_path("/");
  EXPECT_THAT(sight_words("python3 '" + entry.path() + "/deep/mine.py' 5;"), Contains(entry.path()));
  EXPECT_THAT(sight_words("PYTHONPATH=" + entry.path() + ":/opt ./mine"), Contains(entry.path()));
  EXPECT_THAT(sight_words("./tmp/" + entry.name() + "/deep/mine.py"), Contains(entry.path())) << "from here";
  EXPECT_THAT(sight_words("python3 " + entry.path() + "/deep/mine.py"), Not(Contains(other.path())));
  EXPECT_THAT(sight_words("cat /tmp /tmp/ /tmp/.. /tmp/no-such-entry-" + entry.name()),
              Not(Contains("/tmp")));
  fs::current_path(entry.path() + "/deep");
  EXPECT_THAT(sight_words("python3 mine.py"), Contains(entry.path()));
  fs::current_path("/");
}

TEST(BoxWords, SecretsOfTheHomeFolderAreHidden) {
  const TemporaryFolder home;
  fs::create_directories(home / ".ssh");
  fs::create_directories(home / "kept");
  fs::create_directory_symlink(home / "kept", home / ".aws");
  std::ofstream(home / ".netrc") << "machine x password y\n";
  ::setenv("HOME", home.path().c_str(), 1);
  const auto words = sight_words("true");
  EXPECT_THAT(words, IsSupersetOf({std::string("--tmpfs"), (home / ".ssh").string(),
                                   (home / ".netrc").string(), (home / "kept").string()}));
  EXPECT_THAT(words, Not(Contains((home / ".gnupg").string()))) << "there is none";
  ::setenv("HOME", "not/a/place", 1);
  EXPECT_THAT(sight_words("true"), Not(Contains("--tmpfs")));
}

TEST(BoxWords, LimitsAreThoseAskedForAndNeverAboveOurOwn) {
  const ProcessLimits limits{.time = 2.5, .cores = 1, .memory = 1'000'000, .file = 2000, .open_files = 30};
  EXPECT_THAT(limit_words(limits), IsSupersetOf({"--cpu=3:4", "--data=4000000:4000000", "--fsize=2000:2000",
                                                 "--nofile=30:30", "--core=0:0"}));
  const rlimit low{20, 20};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  EXPECT_THAT(limit_words(limits), Contains("--nofile=20:20"));
}

TEST(BoxWords, NoWordOfTheProbeNeedsQuoting) {
  for (const std::string& word : namespace_words({}))
    EXPECT_EQ(word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/-"),
              std::string::npos)
        << word;
}

}  // namespace
}  // namespace understudy::calibration
