#include "tests/cli/program_run.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace understudy::cli_test {
namespace fs = std::filesystem;
namespace {

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Outcome shell(const std::string& prefix, const std::string& words) {
  const Folder folder;
  const std::string command =
      prefix + " " UNDERSTUDY_PROGRAM " " + words + " >" + (folder / "out") + " 2>" + (folder / "err");
  const int raw = std::system(command.c_str());
  Outcome outcome;
  outcome.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  outcome.out = slurp(folder / "out");
  outcome.err = slurp(folder / "err");
  return outcome;
}

}  // namespace

Outcome understudy(const std::string& words) { return shell("", words); }

Outcome understudy_interrupted(const std::string& words, double seconds) {
  return shell("timeout --foreground --preserve-status -s INT " + std::to_string(seconds), words);
}

Outcome understudy_after(const std::string& shell_words, const std::string& words) {
  return shell(shell_words, words);
}

std::string with_small_disk(const std::string& folder, int kilobytes) {
  return "unshare -m sh -c 'mount -t tmpfs -o size=" + std::to_string(kilobytes) + "k none \"" + folder +
         "\" && { \"$0\" \"$@\"; status=$?; ls -A \"" + folder + "\"; exit $status; }'";
}

bool can_make_disks() {
  const Folder folder;
  return std::system((with_small_disk(folder.path().string(), 8) + " true >/dev/null 2>&1").c_str()) == 0;
}

std::string without_progress(const std::string& err) {
  std::istringstream lines(err);
  std::string rest;
  for (std::string line; std::getline(lines, line);) {
    const auto after = line.find_first_not_of(" 0123456789");
    if (after == std::string::npos || line.compare(after, 2, "% ") != 0) rest += line + "\n";
  }
  return rest;
}

Folder::Folder() {
  static int count = 0;
  path_ = fs::temp_directory_path() /
          ("understudy-cli-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

Folder::~Folder() { fs::remove_all(path_); }

std::string Folder::write(const std::string& name, const std::string& content) const {
  std::ofstream(path_ / name, std::ios::binary) << content;
  return (path_ / name).string();
}

int Folder::entries() const { return static_cast<int>(std::distance(fs::directory_iterator(path_), {})); }

}  // namespace understudy::cli_test
