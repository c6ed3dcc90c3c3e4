#include "drivers/port_uri.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::drivers {
namespace {

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(PortUri, HasSchemePlaceAndOptions) {
  const PortUri uri = parse_port_uri("Serial:///dev/ttyACM0?baud=250000&family=marlin");
  EXPECT_EQ(uri.scheme, "serial");
  EXPECT_EQ(uri.place, "/dev/ttyACM0");
  EXPECT_EQ(uri.option("family"), "marlin");
  EXPECT_EQ(uri.number("baud", 115200, 9600, 4e6), 250000);
  EXPECT_EQ(uri.number("latency_ms", 250, 1, 1000), 250) << "not given";
  EXPECT_TRUE(parse_port_uri("loopback://").place.empty());
}

TEST(PortUri, SaysWhatIsWrongInIt) {
  EXPECT_THAT(refusal([] { parse_port_uri("/dev/ttyACM0"); }), testing::HasSubstr("write SCHEME://PLACE"));
  EXPECT_THAT(refusal([] { parse_port_uri("tcp://a:1?x"); }), testing::HasSubstr("'x' is no KEY=VALUE"));
  EXPECT_THAT(refusal([] { parse_port_uri("tcp://a:1?x=1&x=2"); }), testing::HasSubstr("x stands twice"));
  EXPECT_THAT(refusal([] {
                parse_port_uri("serial:///d?bawd=1").check_options({"baud", "family"});
              }),
              testing::HasSubstr("unknown option 'bawd'; did you mean 'baud'?"));
  EXPECT_THAT(refusal([] { (void)parse_port_uri("serial:///d?baud=fast").number("baud", 1, 300, 4e6); }),
              testing::HasSubstr("baud 'fast' is no number from 300 to 4000000"));
}

}  // namespace
}  // namespace understudy::drivers
