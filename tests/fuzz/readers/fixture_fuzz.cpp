// Bytes as a fixture file; a shape stands beside it.
#include "machine/fixture_file.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("clamp.yaml"), shape("box.stl");
  static const std::string solid = shape.fill("solid box\nendsolid box\n").string();
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  if (!fuzz::accepts(size, file, [&] { machine::check_fixture_file(file); })) return 0;
  const std::string found = machine::find_fixture(file);
  fuzz::require(std::filesystem::is_regular_file(found), "its shape is no file: " + found);
  const machine::BuiltTolerances t = machine::load_built_tolerances("hexapod", file);
  for (const double value : {t.part_position, t.part_rotation, t.part_size, t.part_ripple}) {
    fuzz::require_finite(value, "tolerance");
    fuzz::require(value >= 0, "a negative tolerance");
  }
  return 0;
}
