// The kinds of open-chain machines. A new mechanism is one file that fills a ChainKind, and one line in
// chain_kind.cpp; machine files then name it in `mechanism:` and give its parameters in `geometry:`.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

/// A number in the `geometry` section of a machine file. Bounds in the unit that the key's suffix names.
struct Parameter {
  std::string key;  ///< "upper_arm_mm"
  double low, high;
  const char* about;
};

struct ChainKind {
  std::string name;                   ///< word of `mechanism:`
  std::vector<Parameter> parameters;  ///< all of them must be given
  /// The chain of these parameters (SI), limits left open. Empty: the machine file lists its axes itself.
  Chain (*chain)(std::span<const double> parameters) = nullptr;
  /// Measured axes may take the place of the drawn ones: the drawn chain's inverse then only gives the start.
  bool may_be_calibrated = false;
  /// nullptr: the numeric inverse serves.
  std::unique_ptr<Mechanism> (*make)(const ChainDescription& description) = nullptr;
};

const std::vector<ChainKind>& chain_kinds();
/// nullptr for a name that is none.
const ChainKind* find_chain_kind(const std::string& name);

ChainKind arm_kind();         ///< "arm": six axes with a spherical wrist, closed form (arm.cpp)
ChainKind five_axis_kind();   ///< "five-axis": three slides and a tilting, turning table (five_axis.cpp)
ChainKind finishing_kind();   ///< "finishing": redundant stage (finishing.cpp)
ChainKind delta_kind();       ///< "delta": three carriages and rods, closed form (delta.cpp)
ChainKind open_chain_kind();  ///< "chain": axes listed in the file, or read from a URDF; numeric inverse

}  // namespace understudy::kinematics
