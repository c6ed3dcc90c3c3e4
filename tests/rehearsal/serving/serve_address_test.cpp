#include "rehearsal/serving/serve_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::rehearsal {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& words) {
  try {
    static_cast<void>(parse_serve_address(words, false));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ServeAddress, ReadsBothForms) {
  const ServeAddress tcp = parse_serve_address("tcp:127.0.0.1:2323", false);
  EXPECT_TRUE(tcp.is_tcp());
  EXPECT_EQ(tcp.host, "127.0.0.1");
  EXPECT_EQ(tcp.port, 2323);
  EXPECT_EQ(parse_serve_address("tcp:[::1]:0", false).host, "::1");
  EXPECT_EQ(parse_serve_address("pty:/tmp/a:b", false).path, "/tmp/a:b");
}

TEST(ServeAddress, OtherComputersNeedASpokenWord) {
  EXPECT_THAT(refusal("tcp:0.0.0.0:2323"), HasSubstr("--network allows it"));
  EXPECT_THAT(refusal("tcp:192.168.1.4:2323"), HasSubstr("is not this computer"));
  EXPECT_EQ(parse_serve_address("tcp:0.0.0.0:2323", true).host, "0.0.0.0");
  EXPECT_EQ(refusal("tcp:localhost:1"), "");
}

TEST(ServeAddress, WhatIsNoneIsOneLine) {
  EXPECT_THAT(refusal("serial:/dev/ttyUSB0"), HasSubstr("tcp:HOST:PORT"));
  EXPECT_THAT(refusal("tcp:127.0.0.1"), HasSubstr("tcp:HOST:PORT"));
  EXPECT_THAT(refusal("tcp:127.0.0.1:port"), HasSubstr("'port' is no port"));
  EXPECT_THAT(refusal("tcp:127.0.0.1:70000"), HasSubstr("to 65535"));
  EXPECT_THAT(refusal("pty:"), HasSubstr("no path"));
}

}  // namespace
}  // namespace understudy::rehearsal
