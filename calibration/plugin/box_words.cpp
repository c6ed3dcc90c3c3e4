#include "calibration/plugin/box_words.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "calibration/plugin/plugin_environment.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

using Words = std::vector<std::string>;

constexpr const char* kPrlimit = "/usr/bin/prlimit";
constexpr const char* kTemporary = "/tmp";
constexpr double kAskedFor = 4;         // of the memory that may be used
constexpr std::size_t kNothing = 4096;  // [bytes], the least that a folder in memory can have

constexpr std::array kSecrets{".ssh",
                              ".gnupg",
                              ".aws",
                              ".azure",
                              ".kube",
                              ".docker",
                              ".config/gcloud",
                              ".config/gh",
                              ".config/git/credentials",
                              ".config/google-chrome",
                              ".config/chromium",
                              ".mozilla",
                              ".thunderbird",
                              ".password-store",
                              ".local/share/keyrings",
                              ".netrc",
                              ".git-credentials",
                              ".pgpass",
                              ".npmrc",
                              ".pypirc",
                              ".cargo/credentials",
                              ".cargo/credentials.toml",
                              ".Xauthority",
                              ".bash_history",
                              ".zsh_history",
                              ".python_history"};

void append(Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); }

/// An empty folder in memory over another.
Words own_folder(const std::string& path, std::size_t bytes) {
  return {"--size", std::to_string(bytes), "--tmpfs", path};
}

Words hidden(const std::string& path, bool folder) {
  if (!folder) return {"--ro-bind", "/dev/null", path};
  Words words = own_folder(path, kNothing);
  append(words, {"--remount-ro", path});
  return words;
}

bool in_a_path(char c) {
  constexpr std::string_view kOthers = "._/+@%~-";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kOthers.find(c) != std::string_view::npos;
}

/// The entry of the real /tmp that holds `path`, if there is one.
void add_entry(const fs::path& path, std::set<std::string>& entries) {
  const fs::path below = path.lexically_normal().lexically_relative(kTemporary);
  if (below.empty() || *below.begin() == ".." || *below.begin() == ".") return;
  const fs::path entry = kTemporary / *below.begin();
  std::error_code unknown;
  if (fs::exists(entry, unknown)) entries.insert(entry.string());
}

/// All that a text names, seen from the current folder.
void add_named(const std::string& text, const fs::path& current, std::set<std::string>& entries) {
  for (auto from = std::ranges::find_if(text, in_a_path); from != text.end();) {
    const auto end = std::find_if_not(from, text.end(), in_a_path);
    add_entry(current / std::string(from, end), entries);
    from = std::find_if(end, text.end(), in_a_path);
  }
}

/// "soft:hard", where the program is told at `soft` and killed at `hard`; neither is above what we have.
template <typename Resource>
std::string limit(Resource resource, double soft, double hard) {
  rlimit now{};
  ::getrlimit(resource, &now);
  const auto low = [&](double wanted) {
    return now.rlim_max == RLIM_INFINITY || wanted < static_cast<double>(now.rlim_max)
               ? fmt::format("{:.0f}", wanted)
               : fmt::format("{}", now.rlim_max);
  };
  return low(soft) + ":" + low(hard);
}

}  // namespace

Words namespace_words(const ProcessLimits& limits) {
  Words words{kBubblewrap,
              "--unshare-all",
              "--unshare-user",
              "--disable-userns",
              "--cap-drop",
              "ALL",
              "--die-with-parent",
              "--new-session",
              "--ro-bind",
              "/",
              "/",
              "--proc",
              "/proc",
              "--dev",
              "/dev"};
  append(words, own_folder("/dev/shm", limits.own_folders));
  append(words, {"--remount-ro", "/dev"});
  std::error_code unknown;
  if (fs::is_directory(kTemporary, unknown)) append(words, own_folder(kTemporary, limits.own_folders));
  if (fs::is_directory("/run", unknown)) append(words, hidden("/run", true));
  append(words, {"--setenv", "TMPDIR", kTemporary});
  return words;
}

Words sight_words(const std::string& command) {
  Words words;
  std::error_code unknown;
  const fs::path current = fs::current_path(unknown);
  std::set<std::string> entries;
  add_entry(current, entries);
  add_named(command, current, entries);
  for (const std::string& entry : plugin_environment())
    if (!entry.starts_with("TMPDIR=")) add_named(entry.substr(entry.find('=') + 1), current, entries);
  for (const std::string& entry : entries) append(words, {"--ro-bind-try", entry, entry});
  const char* home = std::getenv("HOME");
  if (!home || fs::path(home).is_relative()) return words;
  for (const char* name : kSecrets) {
    const fs::path path = fs::canonical(fs::path(home) / name, unknown);
    if (!unknown && *std::next(path.begin()) != "run")  // which is empty already
      append(words, hidden(path.string(), fs::is_directory(path, unknown)));
  }
  return words;
}

Words limit_words(const ProcessLimits& limits) {
  if (::access(kPrlimit, X_OK) != 0) return {};
  const double cpu = std::max(1.0, std::ceil(limits.cpu_time()));
  const auto memory = kAskedFor * static_cast<double>(limits.memory);
  const auto file = static_cast<double>(limits.file);
  const double open_files = limits.open_files;
  // Of the memory that may be written to. Programs with many threads ask for much more than they use: what
  // they use is watched by run_process().
  return {kPrlimit,
          "--core=0:0",
          "--cpu=" + limit(RLIMIT_CPU, cpu, cpu + 1),
          "--data=" + limit(RLIMIT_DATA, memory, memory),
          "--fsize=" + limit(RLIMIT_FSIZE, file, file),
          "--nofile=" + limit(RLIMIT_NOFILE, open_files, open_files),
          "--"};
}

}  // namespace understudy::calibration
