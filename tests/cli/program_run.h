// Runs the real command as a user does.
#pragma once

#include <filesystem>
#include <string>

namespace understudy::cli_test {

inline const std::string kSource = UNDERSTUDY_SOURCE_DIR;

struct Outcome {
  int status = -1;  ///< exit status, or 128 + signal
  std::string out, err;
};

/// `words` follow the program's name; a shell splits them.
Outcome understudy(const std::string& words);

/// The same, with SIGINT after `seconds`.
Outcome understudy_interrupted(const std::string& words, double seconds);

/// The same behind words of a shell, such as "ulimit -f 8;".
Outcome understudy_after(const std::string& shell_words, const std::string& words);

/// Words for understudy_after(): a disk of so many kB at `folder`, which only the command sees. What lies on
/// it at the end is printed.
std::string with_small_disk(const std::string& folder, int kilobytes);
/// Whether there can be such a disk here.
bool can_make_disks();

/// What a command wrote to standard error, less the lines that tell how far it is: in a pipe there is one
/// after each ten seconds, which a slow computer needs.
std::string without_progress(const std::string& err);

/// A fresh folder that is removed with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& content) const;
  int entries() const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace understudy::cli_test
