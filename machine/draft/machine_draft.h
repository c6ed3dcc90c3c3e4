// A first machine.yaml of a machine that nobody has described yet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understudy::machine {

/// A file that belongs beside machine.yaml.
struct DraftFile {
  std::string name;  ///< relative to the folder of machine.yaml
  std::string content;
};

struct MachineDraft {
  std::string text;  ///< of machine.yaml
  std::vector<DraftFile> files;
  int axes = 0;
  std::string base_link, tool_link;    ///< of a URDF
  std::vector<std::string> assumed;    ///< words of the key `assumed`
  std::vector<std::string> unchecked;  ///< links whose meshes are nowhere, or no bodies
  std::string place_note;              ///< where no place for the table was found: what to do
};

struct UrdfDraftRequest {
  std::string name;
  std::filesystem::path urdf;        ///< expanded
  std::string base_link, tool_link;  ///< empty: guessed
  std::filesystem::path srdf;        ///< empty: none
  std::filesystem::path packages;  ///< folder of the packages of meshes; empty: beside the URDF and above it
};

/// Ranges, masses, velocities and collision shapes are the URDF's; where the table stands, home, drives,
/// play, tolerances, the tool and its motion are assumed. The table stands where the tool can stand upright
/// all over it, far from singular postures. Throws as read_urdf(), and for links that cannot be guessed.
MachineDraft draft_of_urdf(const UrdfDraftRequest& request);

/// A machine that is there, under another name: all its figures count as assumed. Throws InputError naming
/// the known machines.
MachineDraft draft_of_kind(const std::string& kind, const std::string& name);

}  // namespace understudy::machine
