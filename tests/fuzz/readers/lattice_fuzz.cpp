// Bytes as a frame of struts in JSON.
#include "tests/fuzz/reader.h"
#include "toolpath/lattice/lattice_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  toolpath::Lattice lattice;
  const std::string text(fuzz::text_of(data, size));
  if (!fuzz::accepts(size, "a.json", [&] { lattice = toolpath::parse_lattice(text, "a.json"); })) return 0;
  const auto check = [&] {
    for (const toolpath::LatticeNode& node : lattice.nodes) fuzz::require_finite(node.position, "node");
    for (std::size_t i = 0; i < lattice.struts.size(); ++i) {
      fuzz::require_finite(lattice.length(i), "length of a strut");
      fuzz::require(lattice.length(i) > 0, "a strut without length");
    }
  };
  check();
  fuzz::require(toolpath::hanging_nodes(lattice).empty(), "a part of the frame hangs in the air");
  toolpath::place_lattice(lattice, 1, Vec3(0, 0, 0.05));
  check();
  return 0;
}
