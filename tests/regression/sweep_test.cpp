#include "regression/sweep.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::regression {
namespace {

namespace fs = std::filesystem;

rehearsal::RehearsalRequest bottle() {
  rehearsal::RehearsalRequest request;
  request.program = (machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode").string();
  request.fixture = "bottle";
  request.engine = "quasistatic";
  request.gap_control = "off";
  request.as_built = "manufactured";
  return request;
}

/// The journal of a sweep that died after its second machine, whose row has a wrong verdict: whoever
/// rehearses that machine again does not see the mark.
std::string marked_journal(const TemporaryFolder& folder) {
  const std::string journal = (folder / "journal").string();
  const auto dies = [](double share, const std::string&) {
    if (share > 0.5) throw MachineError("killed");
  };
  EXPECT_THROW(sweep(bottle(), 1, 3, 1, dies, journal), MachineError);
  std::string kept = read_file(journal);
  const auto line = kept.find("\n1 ") + 3;
  kept.replace(line, kept.find(' ', line) - line, "1");
  const bool was_go = read_file(journal) == kept;
  if (was_go) kept.replace(line, 1, "0");
  write_file(journal, kept);
  return journal;
}

TEST(Sweep, AKilledOneGoesOnWithTheSameRows) {
  const TemporaryFolder folder;
  const std::string journal = marked_journal(folder);
  const auto resumed = sweep(bottle(), 1, 3, 1, {}, journal);
  EXPECT_FALSE(fs::exists(journal));
  const auto whole = sweep(bottle(), 1, 3, 1);
  ASSERT_EQ(resumed.size(), 3u);
  EXPECT_NE(resumed[1].go, whole[1].go);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(resumed[i].seed, whole[i].seed);
    EXPECT_EQ(resumed[i].start_mm, whole[i].start_mm);
    EXPECT_EQ(resumed[i].in_band_fraction, whole[i].in_band_fraction);
    EXPECT_EQ(resumed[i].touched, whole[i].touched);
  }
}

TEST(ExtendedSweep, AChangedInputBeginsAnewThoughTheFirstMachineDoesNotShowIt) {
  rehearsal::RehearsalRequest changed = bottle();
  changed.orientation_tolerance_deg = 44;
  const TemporaryFolder folder;
  const auto anew = sweep(changed, 1, 3, 1, {}, marked_journal(folder));
  const auto whole = sweep(changed, 1, 3, 1);
  EXPECT_EQ(anew[0].go, whole[0].go);
  EXPECT_EQ(anew[1].go, whole[1].go);
}

}  // namespace
}  // namespace understudy::regression
