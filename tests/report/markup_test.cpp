#include "report/markup.h"

#include <gtest/gtest.h>

namespace understudy::report {
namespace {

TEST(Markup, IsTextInElementsAndAttributes) {
  EXPECT_EQ(html_text("<a href=\"x\">R&D</a>"), "&lt;a href=&quot;x&quot;&gt;R&amp;D&lt;/a&gt;");
  EXPECT_EQ(html_text("caf\xC3\xA9"), "caf\xC3\xA9");
}

}  // namespace
}  // namespace understudy::report
