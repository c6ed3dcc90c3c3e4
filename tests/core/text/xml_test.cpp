#include "core/text/xml.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Xml, ElementsComeInTheOrderInWhichTheyWereAdded) {
  tinyxml2::XMLDocument document;
  auto& robot = add_element(document, "robot", {{"name", "arm"}, {"axes", "6"}});
  add_element(add_element(robot, "link"), "mass", {{"value", "1.50"}});
  add_element(robot, "joint");
  EXPECT_EQ(to_text(document),
            "<robot name=\"arm\" axes=\"6\">\n"
            "    <link>\n"
            "        <mass value=\"1.50\"/>\n"
            "    </link>\n"
            "    <joint/>\n"
            "</robot>\n");
}

TEST(Xml, NamesAreEscapedAndReadBackAsTheyWere) {
  const std::string name = "a<b & \"c\" 'd'>";
  tinyxml2::XMLDocument document, read;
  add_element(document, "link", {{"name", name}});
  ASSERT_EQ(read.Parse(to_text(document).c_str()), tinyxml2::XML_SUCCESS);
  EXPECT_EQ(read.FirstChildElement("link")->Attribute("name"), name);
}

}  // namespace
}  // namespace understudy
