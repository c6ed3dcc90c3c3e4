#include "kinematics/chain/chain_kind.h"

#include "kinematics/chain/calibrated_chain.h"

namespace understudy::kinematics {

const std::vector<ChainKind>& chain_kinds() {
  static const std::vector<ChainKind> kinds{arm_kind(), five_axis_kind(), finishing_kind(), delta_kind(),
                                            open_chain_kind()};
  return kinds;
}

const ChainKind* find_chain_kind(const std::string& name) {
  for (const ChainKind& kind : chain_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::unique_ptr<Mechanism> make_chain_mechanism(const ChainDescription& description) {
  if (!description.design.axes.empty()) return make_calibrated_chain(description);
  const ChainKind* kind = find_chain_kind(description.kind);
  if (kind == nullptr || kind->make == nullptr) kind = find_chain_kind("chain");
  return kind->make(description);
}

}  // namespace understudy::kinematics
