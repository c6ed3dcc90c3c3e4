#include "core/process/error_output.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(ErrorOutput, KeepsTheLastWordAndPassesOnTheRest) {
  ErrorOutput said;
  EXPECT_EQ(said.take(" 10% printing\r"), " 10% printing\r");
  EXPECT_EQ(said.take("underst"), "");
  EXPECT_EQ(said.take("ood\nunderstudy: first\n"), "understood\n");
  EXPECT_EQ(said.take("understudy: --tilt is 500\n"), "understudy: first\n");
  EXPECT_EQ(said.reason(), "--tilt is 500");
  EXPECT_EQ(said.rest(), "understudy: --tilt is 500\n");
  EXPECT_EQ(said.reason(), "");
}

TEST(ErrorOutput, ALineWithoutAnEndIsNoReasonYet) {
  ErrorOutput said;
  EXPECT_EQ(said.take("understudy: half"), "");
  EXPECT_EQ(said.reason(), "");
  EXPECT_EQ(said.rest(), "understudy: half");
}

TEST(ErrorOutput, PassesProgressOnAsItComes) {
  ErrorOutput said;
  EXPECT_EQ(said.take("warning: 1 of 2"), "warning: 1 of 2");
  EXPECT_EQ(said.take(" struts\n"), " struts\n");
}

}  // namespace
}  // namespace understudy
