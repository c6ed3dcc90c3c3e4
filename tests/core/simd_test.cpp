#include "core/simd.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy {
namespace {

class SimdChoice : public testing::Test {
 protected:
  ~SimdChoice() override { ::unsetenv("UNDERSTUDY_SIMD"); }
  static Simd chosen(const char* word) {
    ::setenv("UNDERSTUDY_SIMD", word, 1);
    return simd();
  }
};

bool kernel_lists_avx2() {
  std::ifstream file("/proc/cpuinfo");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.find(" avx2 ") != std::string::npos;
}

TEST_F(SimdChoice, IsTheMostThatTheProcessorHas) {
  ::unsetenv("UNDERSTUDY_SIMD");
  EXPECT_EQ(simd(), kernel_lists_avx2() ? Simd::avx2 : Simd::sse2);
  EXPECT_EQ(chosen(""), simd());
}

TEST_F(SimdChoice, IsWhatTheUserSays) {
  EXPECT_EQ(chosen("scalar"), Simd::scalar);
  EXPECT_EQ(chosen("sse2"), Simd::sse2);
  if (kernel_lists_avx2())
    EXPECT_EQ(chosen("avx2"), Simd::avx2);
  else
    EXPECT_THROW(chosen("avx2"), InputError);
}

TEST_F(SimdChoice, RefusesAWordThatIsNone) {
  try {
    chosen("avx1");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::StrEq("UNDERSTUDY_SIMD=avx1: say scalar, sse2 or avx2"));
  }
}

}  // namespace
}  // namespace understudy
