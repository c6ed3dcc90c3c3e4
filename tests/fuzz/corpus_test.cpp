// Every input of the corpus, through the target of its reader.
#include <algorithm>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/fuzz/reader.h"
#include "tests/fuzz/targets.h"

namespace understudy::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargest = 3072;  // [bytes]: inputs are kept small, or nobody reads them

const fs::path kCorpus = UNDERSTUDY_SOURCE_DIR "/tests/fuzz/corpus";

std::vector<fs::path> inputs_of(const std::string& reader) {
  std::vector<fs::path> inputs;
  for (const auto& entry : fs::directory_iterator(kCorpus / reader)) inputs.push_back(entry.path());
  std::sort(inputs.begin(), inputs.end());
  return inputs;
}

class FuzzCorpus : public ::testing::TestWithParam<const char*> {};

TEST_P(FuzzCorpus, EveryInputIsAcceptedOrRefusedAndReadsBackTheSame) {
  const std::vector<fs::path> inputs = inputs_of(GetParam());
  EXPECT_FALSE(inputs.empty());
  for (const fs::path& input : inputs) {
    SCOPED_TRACE(input.string());
    EXPECT_LE(fs::file_size(input), kLargest);
    EXPECT_NO_THROW(run(GetParam(), read_file(input)));
  }
}

TEST_P(FuzzCorpus, WhatIsCutOffAnywhereIsAcceptedOrRefused) {
  for (const fs::path& input : inputs_of(GetParam())) {
    SCOPED_TRACE(input.string());
    const std::string whole = read_file(input);
    for (const int eighths : {0, 1, 3, 5, 7})
      EXPECT_NO_THROW(run(GetParam(), whole.substr(0, whole.size() * static_cast<std::size_t>(eighths) / 8)))
          << eighths << "/8 of it";
  }
}

std::vector<const char*> readers() {
  std::vector<const char*> names;
  for (const Target& target : targets()) names.push_back(target.reader);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Reader, FuzzCorpus, ::testing::ValuesIn(readers()),
                         [](const auto& of) { return std::string(of.param); });

TEST(FuzzTargets, HaveACorpusEachAndNoFolderIsLeftOver) {
  std::set<std::string> names, folders;
  for (const Target& target : targets()) names.insert(target.reader);
  for (const auto& entry : fs::directory_iterator(kCorpus)) folders.insert(entry.path().filename().string());
  EXPECT_EQ(names, folders);
}

}  // namespace
}  // namespace understudy::fuzz
