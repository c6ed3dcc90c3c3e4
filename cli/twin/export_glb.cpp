#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "report/gltf/replay_glb.h"
#include "report/page/recorded_replay.h"

namespace understudy::cli {
namespace {

struct GlbRequest {
  std::string folder, output, colour;
  std::size_t slices = report::GlbSettings{}.slices;
  double within_mm = to_mm(report::GlbSettings{}.within), speed = 1;
};

int export_glb(const GlbRequest& r) {
  if (std::filesystem::path(r.output).extension() != ".glb")
    throw InputError("--output " + r.output + ": does not end in .glb, by which viewers know it");
  check_writable(r.output);
  report::GlbSettings settings;
  if (!r.colour.empty()) settings.colour = report::bead_colour_of(r.colour);
  settings.slices = r.slices;
  settings.within = from_mm(r.within_mm);
  settings.speed = r.speed;
  const report::RecordedReplay replay = report::read_recorded_replay(r.folder);
  const report::Glb glb = report::replay_glb(replay, settings);
  write_file(r.output, glb.bytes);
  fmt::print("{}: {:.1f} MB, {} triangles, {:.1f} s with {} keys\n", r.output,
             1e-6 * static_cast<double>(glb.bytes.size()), glb.triangles, glb.duration, glb.keys);
  if (glb.slices > 0)
    fmt::print("  beads in {} slices of {:.3f} s; colour: {}\n", glb.slices, glb.slice_time, glb.legend);
  else
    fmt::print(stderr, "understudy: note: the record has no beads: the file shows the machine alone\n");
  for (const std::string& shortfall : replay.shortfalls)
    fmt::print(stderr, "understudy: note: {}\n", shortfall);
  return kGood;
}

}  // namespace

void add_export_glb(CLI::App& command, Action& action) {
  auto request = std::make_shared<GlbRequest>();
  auto* glb = command.add_subcommand(
      "glb", "A rehearsal for viewers of glTF 2.0: machine, part and beads, and how they move");
  glb->footer(
      "Example: understudy rehearse part.gcode --out part && understudy export glb part -o part.glb\n"
      "Blender, three.js and the viewer of Windows open it (docs/viewers.md).");
  glb->add_option("folder", request->folder, "results of understudy rehearse")->required();
  glb->add_option(
      "--colour", request->colour,
      "of the beads: gap, width or plain; without it by gap where the machine states one, else by "
      "width");
  glb->add_option("--slices", request->slices, "equal times in which the beads appear")
      ->capture_default_str();
  glb->add_option("--within", request->within_mm, "mm by which a body may be off what the record says")
      ->capture_default_str();
  glb->add_option("--speed", request->speed, "so many times as fast as the run")->capture_default_str();
  glb->add_option("-o,--output", request->output, "file to write, FILE.glb")->required();
  glb->callback([=, &action] { action = [=] { return export_glb(*request); }; });
}

}  // namespace understudy::cli
