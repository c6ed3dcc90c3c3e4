#include "core/file/descriptor.h"

#include <fcntl.h>

#include <utility>

#include <gtest/gtest.h>

namespace understudy {
namespace {

bool is_open(int descriptor) { return ::fcntl(descriptor, F_GETFD) >= 0; }

TEST(Descriptor, IsClosedOnceAndByItsLastOwner) {
  int number = -1;
  {
    Descriptor first(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    number = first.get();
    ASSERT_TRUE(first.is_open() && is_open(number));
    const Descriptor second = std::move(first);
    EXPECT_TRUE(second.is_open() && is_open(number));
    EXPECT_FALSE(first.is_open());  // NOLINT(bugprone-use-after-move)
  }
  EXPECT_FALSE(is_open(number));
}

TEST(Descriptor, MayBeClosedBeforeItGoes) {
  Descriptor file(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const int number = file.get();
  file.close();
  EXPECT_FALSE(file.is_open() || is_open(number));
  EXPECT_EQ(file.get(), -1) << "closed again, it would close what another opened since";
}

TEST(Descriptor, OfNothingIsNotOpen) { EXPECT_FALSE(Descriptor().is_open()); }

}  // namespace
}  // namespace understudy
