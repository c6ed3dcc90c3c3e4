#include "cli/new_machine_command.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/expanded_xacro.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "machine/draft/machine_draft.h"

namespace understudy::cli {
namespace fs = std::filesystem;
namespace {

struct NewMachineRequest {
  std::string urdf, kind, output, srdf, packages, base_link, tool_link;
  std::vector<std::string> xacro_arguments;
};

/// A folder that is filled beside its place and then takes it; gone where something is refused before.
class NewFolder {
 public:
  explicit NewFolder(const fs::path& target) : target_(target), working_(target.string() + ".part") {
    std::error_code error;
    if (fs::exists(fs::symlink_status(target_, error)))
      throw InputError(fmt::format("{} is there already: name a folder that is not", target_.string()));
    fs::remove_all(working_, error);
    check_writable(working_);
    fs::create_directories(working_, error);
    if (error) throw InputError(fmt::format("cannot make {}: {}", working_.string(), error.message()));
  }
  ~NewFolder() {
    std::error_code ignored;
    fs::remove_all(working_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  void write(const std::string& name, const std::string& content) const {
    const fs::path path = working_ / name;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    write_file(path, content);
  }
  const fs::path& path() const { return working_; }
  void commit() const {
    std::error_code error;
    fs::rename(working_, target_, error);
    if (error) throw MachineError(fmt::format("cannot write {}: {}", target_.string(), error.message()));
  }

 private:
  fs::path target_, working_;
};

machine::MachineDraft draft_from_urdf(const NewMachineRequest& r, const std::string& name) {
  machine::UrdfDraftRequest request{name, r.urdf, r.base_link, r.tool_link, r.srdf, r.packages};
  if (fs::path(r.urdf).extension() != ".xacro") return machine::draft_of_urdf(request);
  const ExpandedXacro expanded(r.urdf, r.xacro_arguments);
  if (request.packages.empty()) request.packages = fs::absolute(r.urdf).parent_path();
  request.urdf = expanded.path();
  return machine::draft_of_urdf(request);
}

/// What the file states that its load shows: the same checks as every command makes.
void check(const fs::path& folder) {
  try {
    machine::load_machine((folder / "machine.yaml").string());
  } catch (const InputError& e) {
    throw InputError(std::string("no machine can be made of it: ") + e.what());
  }
}

void print_draft(const NewMachineRequest& r, const machine::MachineDraft& draft) {
  const fs::path file = fs::path(r.output) / "machine.yaml";
  if (r.kind.empty())
    fmt::print("{}: {} axes from {} to {}\n", file.string(), draft.axes, draft.base_link, draft.tool_link);
  else
    fmt::print("{}: as {}\n", file.string(), r.kind);
  fmt::print("  assumed, to be measured: {}\n", fmt::join(draft.assumed, ", "));
  if (!draft.unchecked.empty())
    fmt::print("  without a mesh that is found and a body, not checked against collisions: {}\n",
               fmt::join(draft.unchecked, ", "));
  if (!draft.place_note.empty()) fmt::print("  {}\n", draft.place_note);
  fmt::print("next: understudy pose --machine {0}, understudy rehearse PROGRAM --machine {0}\n",
             r.output.find('/') == std::string::npos ? "./" + r.output : r.output);
}

int new_machine(const NewMachineRequest& r) {
  if (r.urdf.empty() == r.kind.empty())
    throw InputError(
        "new-machine takes a URDF or --kind, one of them: understudy new-machine arm.urdf -o my-arm");
  fs::path named = fs::path(r.output).lexically_normal();
  if (named.filename().empty()) named = named.parent_path();
  const NewFolder folder(named);
  const std::string name = named.filename().string();
  const machine::MachineDraft draft =
      r.kind.empty() ? draft_from_urdf(r, name) : machine::draft_of_kind(r.kind, name);
  folder.write("machine.yaml", draft.text);
  for (const machine::DraftFile& file : draft.files) folder.write(file.name, file.content);
  check(folder.path());
  folder.commit();
  print_draft(r, draft);
  return kGood;
}

}  // namespace

void add_new_machine(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "new-machine",
      "Write the folder of a new machine, from a URDF or as a ready machine is, every key explained");
  auto request = std::make_shared<NewMachineRequest>();
  command->add_option("urdf", request->urdf, "arm.urdf, or arm.xacro where xacro is installed");
  command->add_option("--kind", request->kind, "instead: a machine of `understudy machines` to begin with");
  command->add_option("-o,--output", request->output, "folder to make")->required();
  command->add_option("--base-link", request->base_link, "link that carries the work; without it, the root");
  command->add_option("--tool-link", request->tool_link,
                      "link that carries the tool; without it, the flange");
  command->add_option("--srdf", request->srdf, "pairs of links that are not checked against each other");
  command->add_option("--packages", request->packages, "folder of the packages that package:// names");
  command->add_option("--xacro-arg", request->xacro_arguments, "NAME:=VALUE for xacro, may be repeated");
  command->footer("docs/arms.md tells what is read, assumed and refused.");
  command->callback([=, &action] { action = [=] { return new_machine(*request); }; });
}

}  // namespace understudy::cli
