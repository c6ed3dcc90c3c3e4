// Bytes as a pattern of places on a part.
#include "control/registration/pattern.h"
#include "geometry/mesh.h"
#include "machine/description.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const machine::MachineDescription machine = machine::load_machine("hexapod");
  static const auto part = geometry::read_stl(machine::models_folder() / "parts" / "slanted_box.stl");
  static const control::ProbingCheck check(machine, *part, 1e-3);
  static const fuzz::InputFile input("pattern.csv");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  std::vector<control::ProbingPlace> places;
  // For each place it is looked for a way to it.
  const auto searches = [&] { return 10 * size; };
  if (!fuzz::accepts(
          size, file, [&] { places = control::read_pattern(file, *part, check); }, searches))
    return 0;
  fuzz::require(std::ssize(places) >= control::kPlacesMin, "too few places");
  for (const control::ProbingPlace& place : places) {
    fuzz::require_finite(place.p_W, "place");
    fuzz::require_finite(check.way_to(place).start, "way to a place");
  }
  return 0;
}
