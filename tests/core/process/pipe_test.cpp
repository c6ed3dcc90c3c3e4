#include "core/process/pipe.h"

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Pipe, EndsWithItsWriterAndIsNotInherited) {
  Pipe pipe;
  EXPECT_EQ(::fcntl(pipe.read.get(), F_GETFD), FD_CLOEXEC);
  EXPECT_EQ(::fcntl(pipe.write.get(), F_GETFD), FD_CLOEXEC);
  char byte = 0;
  ASSERT_EQ(::write(pipe.write.get(), "a", 1), 1);
  pipe.write.close();
  EXPECT_EQ(::read(pipe.read.get(), &byte, 1), 1);
  EXPECT_EQ(byte, 'a');
  EXPECT_EQ(::read(pipe.read.get(), &byte, 1), 0);
}

}  // namespace
}  // namespace understudy
