#include "sim/surface/as_printed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/file/output_folder.h"
#include "core/file/staged_file.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/units.h"
#include "sim/beads/bead_shape.h"

namespace understudy::sim {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little, "both formats are little endian");

constexpr std::size_t kChunk = 8192;  // sections: some 20 MB of triangles
constexpr double kColoured = 1e-3;    // [m], between vertices that a deviation is written at

std::string mm(double metres) { return std::to_string(to_mm(metres)) + " mm"; }

template <typename Number>
void put(std::string& bytes, Number value) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &value, sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

void put_mm(std::string& bytes, const Vec3& p) {
  for (const double x : p) put(bytes, static_cast<float>(to_mm(x)));
}

// Written in a temporary folder beside the target, so that an interrupted export leaves nothing.
class StreamedFile {
 public:
  explicit StreamedFile(const fs::path& path)
      : path_(path), folder_(path.string() + ".unfinished"), out_(folder_.path() / "part", std::ios::binary) {
    write({});
  }

  void write(const std::string& bytes) {
    stop_if_interrupted();
    out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!out_) failed_to_write(path_, errno);
  }
  void commit() {
    out_.close();
    if (!out_) failed_to_write(path_, errno);
    std::error_code error;
    fs::rename(folder_.path() / "part", path_, error);
    if (error) failed_to_write(path_, error.value());
  }

 private:
  fs::path path_;
  OutputFolder folder_;
  std::ofstream out_;
};

void check(const BeadIndex& beads, const AsPrintedSettings& settings) {
  if (beads.size() == 0) throw InputError("no part as printed: 0 beads were laid");
  if (!(settings.limit > 0 && std::isfinite(settings.limit)))
    throw InputError("the colour scale ends at " + mm(settings.limit) + ", which is not above 0");
  if (settings.skin && settings.intended == nullptr)
    throw InputError("a skin of " + mm(*settings.skin) + " needs the intended part");
  if (settings.skin && !(*settings.skin >= 0))
    throw InputError("a skin of " + mm(*settings.skin) + " is below 0");
}

// Fills `count` items by `work(index)`, each on its own, on several threads. One item takes microseconds:
// jobs are of many.
template <typename Work>
void fill(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t kItems = 256;
  in_parallel((count + kItems - 1) / kItems, threads > 0 ? threads : hardware_threads(),
              [&](std::size_t job) {
                const std::size_t last = std::min(count, (job + 1) * kItems);
                for (std::size_t i = job * kItems; i < last; ++i) work(i);
              });
}

/// What is written: beads that follow each other as one body.
struct Chosen {
  std::size_t beads = 0;
  std::vector<BeadStretch> stretches;
};

Chosen chosen(const BeadIndex& beads, const AsPrintedSettings& settings) {
  std::vector<char> in(beads.size(), 1);
  if (settings.skin) {
    fill(beads.size(), settings.threads, [&](std::size_t i) {
      const BeadCore core = core_of(beads.bead(i));
      const bool near = settings.intended->signed_distance(core.middle) > -(*settings.skin + core.reach());
      in[i] = near ? 1 : 0;
    });
  }
  Chosen result;
  result.beads = static_cast<std::size_t>(std::count(in.begin(), in.end(), 1));
  if (result.beads == 0)
    throw InputError("no part as printed: all " + std::to_string(beads.size()) +
                     " beads are deeper than the skin of " + mm(*settings.skin));
  SweepSettings sweep;
  sweep.tolerance = settings.tolerance;
  sweep.chosen = &in;
  if (settings.intended) sweep.longest = kColoured;
  result.stretches = sweep_beads(beads, sweep);
  return result;
}

AsPrintedSize size_of(const Chosen& chosen, int sides, std::size_t most, const std::string& format) {
  AsPrintedSize size;
  size.beads = chosen.beads;
  for (const BeadStretch& stretch : chosen.stretches) {
    const ShellSize one = sweep_size(stretch, sides);
    size.vertices += one.vertices;
    size.triangles += one.triangles;
  }
  if (std::max(size.triangles, size.vertices) > most)
    throw InputError("the part as printed has " + std::to_string(size.triangles) +
                     " triangles, more than the " + std::to_string(most) + " of a " + format +
                     " file: use fewer sides or a thinner skin");
  return size;
}

template <typename Write>
void for_each_chunk(const Chosen& chosen, int sides, const Write& write) {
  BeadMesh mesh;
  std::size_t sections = 0;
  for (const BeadStretch& stretch : chosen.stretches) {
    append_sweep(stretch, sides, mesh);
    sections += stretch.size();
    if (sections < kChunk && &stretch != &chosen.stretches.back()) continue;
    write(mesh);
    mesh.vertices.clear();
    mesh.triangles.clear();
    sections = 0;
  }
}

std::string ply_header(const AsPrintedSize& size, const AsPrintedSettings& settings) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment part as printed, millimetres\n";
  if (settings.intended)
    text += "comment deviation from the intended surface, outward positive; blue -" + mm(settings.limit) +
            ", white 0, red +" + mm(settings.limit) + ", clamped beyond\n";
  text += "element vertex " + std::to_string(size.vertices) + "\n";
  text += "property float x\nproperty float y\nproperty float z\n";
  if (settings.intended)
    text += "property float deviation_mm\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
  text += "element face " + std::to_string(size.triangles) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  return text;
}

std::string ply_vertices(const BeadMesh& mesh, const AsPrintedSettings& settings) {
  std::vector<double> deviation(settings.intended ? mesh.vertices.size() : 0);
  fill(deviation.size(), settings.threads,
       [&](std::size_t v) { deviation[v] = settings.intended->signed_distance(mesh.vertices[v]); });
  std::string bytes;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    put_mm(bytes, mesh.vertices[v]);
    if (!settings.intended) continue;
    put(bytes, static_cast<float>(to_mm(deviation[v])));
    for (const std::uint8_t channel : deviation_colour(deviation[v], settings.limit)) put(bytes, channel);
  }
  return bytes;
}

}  // namespace

AsPrintedSize write_as_printed_stl(const fs::path& path, const BeadIndex& beads,
                                   const AsPrintedSettings& settings) {
  check(beads, settings);
  const Chosen which = chosen(beads, settings);
  const AsPrintedSize size = size_of(which, settings.sides, std::numeric_limits<std::uint32_t>::max(), "STL");
  StreamedFile file(path);
  std::string bytes = "part as printed, millimetres";
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(size.triangles));
  file.write(bytes);
  for_each_chunk(which, settings.sides, [&](const BeadMesh& mesh) {
    bytes.clear();
    for (const auto& triangle : mesh.triangles) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices[static_cast<std::size_t>(triangle[k])];
      const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
      for (const double x : normal) put(bytes, static_cast<float>(x));
      for (const Vec3& corner : p) put_mm(bytes, corner);
      put(bytes, std::uint16_t{0});
    }
    file.write(bytes);
  });
  file.commit();
  return size;
}

AsPrintedSize write_as_printed_ply(const fs::path& path, const BeadIndex& beads,
                                   const AsPrintedSettings& settings) {
  check(beads, settings);
  const Chosen which = chosen(beads, settings);
  const AsPrintedSize size = size_of(which, settings.sides, std::numeric_limits<std::int32_t>::max(), "PLY");
  StreamedFile file(path);
  file.write(ply_header(size, settings));
  for_each_chunk(which, settings.sides,
                 [&](const BeadMesh& mesh) { file.write(ply_vertices(mesh, settings)); });
  std::int32_t first = 0;
  for_each_chunk(which, settings.sides, [&](const BeadMesh& mesh) {
    std::string bytes;
    for (const auto& triangle : mesh.triangles) {
      put(bytes, std::uint8_t{3});
      for (const int v : triangle) put(bytes, first + v);
    }
    file.write(bytes);
    first += static_cast<std::int32_t>(mesh.vertices.size());
  });
  file.commit();
  return size;
}

AsPrintedSize write_as_printed(const fs::path& path, const BeadIndex& beads,
                               const AsPrintedSettings& settings) {
  const std::string ending = path.extension().string();
  if (ending == ".stl") return write_as_printed_stl(path, beads, settings);
  if (ending == ".ply") return write_as_printed_ply(path, beads, settings);
  throw InputError("the part as printed is written as .stl or .ply, not as \"" + ending +
                   "\": " + path.string());
}

std::array<std::uint8_t, 3> deviation_colour(double deviation, double limit) {
  constexpr std::array<double, 3> kBlue{33, 102, 172}, kWhite{247, 247, 247}, kRed{178, 24, 43};
  const double share = std::clamp(deviation / limit, -1.0, 1.0);
  const auto& end = share < 0 ? kBlue : kRed;
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<std::uint8_t>(std::lround(kWhite[i] + std::abs(share) * (end[i] - kWhite[i])));
  return colour;
}

}  // namespace understudy::sim
