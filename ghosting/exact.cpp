// SPDX-License-Identifier: Apache-2.0
// Exact: every sub-model has ghosts of all elements that its own may touch. They carry state only. Each side works out
// the same contact forces from the same states and moves its own elements, so nothing has to be joined, and the model
// goes on as if it were not cut, bit for bit.
#include "ghosting/coupling.hpp"

namespace moraine {
namespace {

class Exact final : public Coupling {
 public:
  bool hosts(SubModelId, SubModelId) const override { return true; }
  void share_out(SharedElement& shared, SubModelId) const override {
    for (Copy& c : shared.copies) c.share = 1;
  }

  double combine(SharedElement& shared, std::span<const CopyMotion>, const CouplingContext&) const override {
    shared.state = shared.end;
    return 0;
  }

  void change_copies(SharedElement& shared, std::span<const SubModelId> worlds, SubModelId) const override {
    shared.copies.clear();
    for (const SubModelId w : worlds) shared.copies.push_back(Copy::in(w));
  }
};

}  // namespace

std::unique_ptr<Coupling> make_exact() { return std::make_unique<Exact>(); }

}  // namespace moraine
