#include "toolpath/inspection/layer_comments.h"

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

TEST(LayerComments, AreThoseOfSlicers) {
  for (const char* comment : {";LAYER_CHANGE", "; CHANGE_LAYER", ";LAYER:0", "; layer 1, Z = 0.2",
                              ";; --- layer 0 (0.250 @ 0.255) ---"}) {
    const LayerComments layers("G1 X1\n" + std::string(comment) + "\r\nG1 X2\n");
    EXPECT_EQ(layers.at(1), 0) << comment;
    EXPECT_EQ(layers.at(3), 1) << comment;
  }
}

TEST(LayerComments, OthersBeginNoLayer) {
  EXPECT_TRUE(LayerComments(";LAYER_COUNT:120\n; layer_height = 0.2\n;AFTER_LAYER_CHANGE\n"
                            "; layer end\nG1 X1 ; layer 2\n; total layer number: 25\n")
                  .empty());
}

TEST(LayerComments, LinesBelongToTheLayerBeforeThem) {
  const LayerComments layers("G28\n;LAYER:0\nG1 X1\nG1 X2\n;LAYER:1\nG1 X3\n");
  EXPECT_EQ(layers.at(4), 1);
  EXPECT_EQ(layers.at(5), 2);
  EXPECT_EQ(layers.at(900), 2);
}

}  // namespace
}  // namespace understudy::toolpath
