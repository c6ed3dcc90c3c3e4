// Runs, kills and a user in any order: a user's files stay, and a result is an old one or a new one, whole.
#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <string>

#include <rapidcheck/state.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "tests/property.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;  // by name

struct Model {
  std::optional<Contents> result;  ///< of the last run that ended well
  Contents foreign;                ///< a user's, in the result's folder
  Contents stranded;               ///< a result that could not take its place, in out.part
  bool killed = false;             ///< a run has left out.part

  bool replaceable() const { return foreign.empty() && stranded.empty(); }
};

struct Files {
  TemporaryFolder root;
  fs::path target() const { return root / "out"; }
  fs::path working() const { return root / "out.part"; }
};

Contents files_in(const fs::path& folder) {
  Contents contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != kManifest)
      contents[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  return contents;
}

std::string drawn_name() {
  return *rc::gen::element<std::string>("summary.json", "trace.csv", "a/b.png", "a/c.png", "a/d/e", "x y\\z");
}

Contents drawn_contents() {
  Contents contents{{"log", "ran"}};
  for (int n = *property::whole(0, 4); n > 0; --n)
    contents[drawn_name()] = std::string(static_cast<std::size_t>(*property::whole(0, 3)), 'r') + "un";
  return contents;
}

void put(const fs::path& folder, const Contents& contents) {
  for (const auto& [name, text] : contents) {
    fs::create_directories((folder / name).parent_path());
    write_file(folder / name, text);
  }
}

struct Command : rc::state::Command<Model, Files> {
  void run(const Model& model, Files& files) const final {
    act(model, files);
    const Model after = nextState(model);
    Contents expected = after.foreign;
    if (after.result) expected.insert(after.result->begin(), after.result->end());
    RC_ASSERT(fs::exists(files.target()) == (after.result || !after.foreign.empty()));
    if (fs::exists(files.target())) RC_ASSERT(files_in(files.target()) == expected);
    RC_ASSERT(fs::exists(files.working()) == (after.killed || !after.stranded.empty()));
    if (!after.stranded.empty()) RC_ASSERT(files_in(files.working()) == after.stranded);
  }
  virtual void act(const Model& model, Files& files) const = 0;
};

struct FinishedRun : Command {
  Contents contents = drawn_contents();
  bool ends_well = *property::whole(0, 3) > 0;
  bool makes_an_empty_folder = *property::whole(0, 4) == 4;
  bool user_meanwhile = *property::whole(0, 5) == 5;  ///< puts a file into the folder

  void apply(Model& model) const override {
    if (model.stranded.empty()) model.killed = false;
    if (!model.replaceable()) return;
    if (user_meanwhile) model.foreign["mine.txt"] = "mine";
    if (!ends_well) return;
    if (!user_meanwhile) {
      model.result = contents;
    } else {
      model.stranded = contents;
      model.stranded["always"] = "";
    }
  }
  void act(const Model& model, Files& files) const override {
    try {
      OutputFolder folder(files.target());
      RC_ASSERT(model.replaceable());
      put(folder.path(), contents);
      if (makes_an_empty_folder) fs::create_directories(folder.path() / "frames" / "none");
      if (user_meanwhile) put(files.target(), {{"mine.txt", "mine"}});
      if (!ends_well) return;
      if (user_meanwhile) write_file(folder.path() / "always", "");
      folder.commit();
      RC_ASSERT(!user_meanwhile);
    } catch (const InputError&) {
      RC_ASSERT(!model.replaceable());
    } catch (const MachineError&) {
      RC_ASSERT(user_meanwhile);
    }
  }
  void show(std::ostream& out) const override {
    out << "run" << (ends_well ? "" : " that fails") << (user_meanwhile ? ", a user meanwhile" : "")
        << (makes_an_empty_folder ? ", an empty folder" : "") << ":";
    for (const auto& [name, text] : contents) out << " " << name << "=" << text;
  }
};

/// SIGKILL while files are written.
struct KilledRun : Command {
  void checkPreconditions(const Model& model) const override { RC_PRE(model.replaceable()); }
  void apply(Model& model) const override { model.killed = true; }
  void act(const Model& /*model*/, Files& files) const override {
    fs::create_directories(files.working() / "a");
    write_file(files.working() / ".understudy-unfinished", "");
    write_file(files.working() / "a" / "half", "hal");
  }
  void show(std::ostream& out) const override { out << "run that is killed"; }
};

struct UserWrites : Command {
  std::string name = *rc::gen::element<std::string>("thesis.tex", "a/photo.jpg", "new/note");
  void apply(Model& model) const override { model.foreign[name] = "precious"; }
  void act(const Model& /*model*/, Files& files) const override { put(files.target(), {{name, "precious"}}); }
  void show(std::ostream& out) const override { out << "user writes " << name; }
};

/// A file of the result is the user's from then on.
struct UserChanges : Command {
  double which = *property::real(0, 0.999);
  std::string name(const Model& model) const {
    const auto step = static_cast<std::ptrdiff_t>(which * static_cast<double>(model.result->size()));
    return std::next(model.result->begin(), step)->first;
  }
  void checkPreconditions(const Model& model) const override {
    RC_PRE((model.result && !model.result->empty()));
  }
  void apply(Model& model) const override {
    const std::string changed = name(model);
    model.result->erase(changed);
    model.foreign[changed] = "edited";
  }
  void act(const Model& model, Files& files) const override {
    write_file(files.target() / name(model), "edited");
  }
  void show(std::ostream& out) const override { out << "user changes a file"; }
};

struct UserRemoves : Command {
  double which = *property::real(0, 0.999);
  std::string name(const Model& model) const {
    const auto step = static_cast<std::ptrdiff_t>(which * static_cast<double>(model.result->size()));
    return std::next(model.result->begin(), step)->first;
  }
  void checkPreconditions(const Model& model) const override {
    RC_PRE((model.result && !model.result->empty()));
  }
  void apply(Model& model) const override { model.result->erase(name(model)); }
  void act(const Model& model, Files& files) const override { fs::remove(files.target() / name(model)); }
  void show(std::ostream& out) const override { out << "user removes a file of the result"; }
};

/// The user moves everything away.
struct UserClears : Command {
  void apply(Model& model) const override { model = Model{}; }
  void act(const Model& /*model*/, Files& files) const override {
    fs::remove_all(files.target());
    fs::remove_all(files.working());
  }
  void show(std::ostream& out) const override { out << "user clears all"; }
};

TEST(OutputFolderProperties, AUsersFilesStayAndResultsAreWhole) {
  property::check({60, 15}, [] {
    Files files;
    rc::state::check(Model{}, files,
                     rc::state::gen::execOneOfWithArgs<FinishedRun, FinishedRun, FinishedRun, KilledRun,
                                                       UserWrites, UserChanges, UserRemoves, UserClears>());
  });
}

}  // namespace
}  // namespace understudy
