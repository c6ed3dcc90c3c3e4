// What a machine file says of its figures besides the figures: which of them nobody measured, and what of the
// machine is not checked against collisions.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace understudy::machine {

struct MachineNotes {
  /// Groups of figures that nobody measured, words of assumptions(): those that the file lists, and "masses"
  /// where a URDF gives none.
  std::vector<std::string> assumed;
  std::vector<std::string> unchecked_links;  ///< of a URDF, whose collision shapes are left out
  /// Names of two bodies that are not checked against each other: an SRDF says so.
  std::vector<std::array<std::string, 2>> apart;
};

/// Throws as load_machine().
MachineNotes load_machine_notes(const std::string& name_or_path);

inline constexpr const char* kAssumedMasses = "masses";

struct Assumption {
  const char* word;      ///< as the key `assumed` has it
  const char* bears_on;  ///< what depends on these figures
};
/// Every word that `assumed` may list.
const std::vector<Assumption>& assumptions();
std::vector<std::string> assumption_words();

/// The word of the figure at this path of a machine file ("axes.home_deg", list indexes left out); empty for
/// what is a choice, a name or a bought part.
std::string assumption_of(const std::string& path);

}  // namespace understudy::machine
