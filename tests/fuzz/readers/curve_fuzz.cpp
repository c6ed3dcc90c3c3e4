// Bytes as a curve in CSV: the form of every table that holds numbers alone.
#include "tests/fuzz/reader.h"
#include "toolpath/planners/curve_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("curve.csv");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  std::vector<Vec3> curve;
  if (!fuzz::accepts(size, file, [&] { curve = toolpath::read_curve_csv(file); })) return 0;
  fuzz::require(curve.size() >= 2, "a curve of fewer than two points");
  for (const Vec3& point : curve) fuzz::require_finite(point, "point");
  return 0;
}
