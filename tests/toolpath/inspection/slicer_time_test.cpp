#include "toolpath/inspection/slicer_time.h"

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

TEST(SlicerTime, IsReadAsSlicersWriteIt) {
  EXPECT_EQ(written_time("16m 11s"), 971);                   // PrusaSlicer
  EXPECT_EQ(written_time("1d 2h 3m 4s"), 93784);             //
  EXPECT_EQ(written_time("38m 1s"), 2281);                   // BambuStudio
  EXPECT_EQ(written_time("6666"), 6666);                     // Cura
  EXPECT_EQ(written_time("12.5 minutes"), 750);              // KISSlicer
  EXPECT_EQ(written_time(" 1 hour 25 minutes\r"), 85 * 60);  // Simplify3D
}

TEST(SlicerTime, OtherTextIsNone) {
  for (const char* text : {"", "soon", "5 parsecs", "-3s", "m", "inf s"})
    EXPECT_FALSE(written_time(text).has_value()) << text;
}

}  // namespace
}  // namespace understudy::toolpath
