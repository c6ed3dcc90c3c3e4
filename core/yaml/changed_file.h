// A file with some of its values changed, told in one word: `hexapod{gap.aim_mm: 0.14, axes.2.play_um: 30}`.
// Whoever takes the name or path of a YAML file takes such a word: a study varies a value without a copy of
// the file.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace understudy {

/// One value: its key with dots, and what stands there. An item of a list is told by its number from 1, or by
/// its `name`.
using ChangedValue = std::pair<std::string, std::string>;

struct ChangedFile {
  std::string file;                   ///< name or path, without the changes
  std::vector<ChangedValue> changes;  ///< in the order of the word
  /// `{key: value, ...}`, or empty: what is added to the name or path of the file.
  std::string braces() const;
};

/// A word that does not end in braces is the file alone. Throws InputError for braces that hold no map of
/// values, a key that is given twice, and a value with a slash or quotes.
ChangedFile changed_file(const std::string& word);

/// The word with further changes; a key that it changes already is changed to the new value.
std::string with_change(const std::string& word, const std::string& key, const std::string& value);

/// The text of the file with its changes in place; all else, comments too, stays as it is. Throws InputError,
/// which begins with `file`, where change_values() would, for a key that is not there within a section that
/// is, and for a value that is no plain word.
std::string changed_text(const std::string& text, const ChangedFile& changed, const std::string& file);

}  // namespace understudy
