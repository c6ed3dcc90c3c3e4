// Bytes as the manifest of a folder of results, which says what a later run may remove.
#include "core/digest.h"
#include "core/file/output_folder.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

namespace fs = std::filesystem;

/// A user's file beside the folder, and one of an earlier run in it.
void lay_out(const fs::path& outside, const fs::path& folder, std::string_view manifest) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  fs::create_directories(folder);
  const auto write = [](const fs::path& path, std::string_view content) {
    const InputFile file(path.lexically_relative(InputFile::folder()).string());
    file.fill(content);
  };
  write(outside, "mine");
  write(folder / "a", "1");
  write(folder / kManifest, manifest);
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  namespace fs = std::filesystem;
  const fs::path folder = fuzz::InputFile::folder() / "results",
                 outside = fuzz::InputFile::folder() / "mine.txt";
  // Of the seeds: the file's own digest and the place of the user's file are not known beforehand.
  std::string manifest(fuzz::text_of(data, size));
  const auto replace = [&manifest](const std::string& word, const std::string& by) {
    for (std::size_t at = 0; (at = manifest.find(word, at)) != std::string::npos; at += by.size())
      manifest.replace(at, word.size(), by);
  };
  replace("DIGEST", sha256_hex("1"));
  replace("FOLDER", fuzz::InputFile::folder().string());
  fuzz::lay_out(outside, folder, manifest);
  const bool replaced = fuzz::accepts(size, folder.string(), [&] {
    OutputFolder output(folder);
    output.commit();
  });
  fuzz::require(fs::exists(outside), "a file outside the folder is gone");
  fuzz::require(replaced || fs::exists(folder / "a"), "a file of a folder that was refused is gone");
  return 0;
}
