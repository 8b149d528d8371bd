// SPDX-License-Identifier: Apache-2.0
#include "runtime/migrate/move.hpp"

#include "runtime/records.hpp"

namespace moraine::runtime {

void append_sub_model(SubModel& sub_model, SubModelId id, Bytes& out) {
  Bytes saved;
  sub_model.save(saved);
  write_records(out, std::vector{id});
  write_records(out, saved);
}

void adopt_all(Model& model, std::span<const std::byte> in) {
  while (!in.empty()) {
    const auto id = read_records<SubModelId>(in);
    const Bytes saved = read_records<std::byte>(in);
    if (id.size() != 1) throw std::runtime_error("a saved sub-model has no number");
    model.adopt(id.front(), saved);
  }
}

Moved move(Model& model, Transport& transport, const std::vector<int>& owners) {
  const Placement before = model.placement();
  Moved moved;
  std::vector<Bytes> leaving(static_cast<std::size_t>(transport.ranks()));
  for (SubModelId id = 0; id < model.size(); ++id) {
    if (before.owner[id] == owners[id]) continue;
    ++moved.sub_models;
    if (!before.holds(id)) continue;
    append_sub_model(model.sub_model(id), id, leaving[static_cast<std::size_t>(owners[id])]);
    model.release(id);
  }
  for (const Bytes& b : leaving) moved.bytes += b.size();
  model.place({before.rank, owners});
  for (const Bytes& coming : transport.exchange(std::move(leaving))) adopt_all(model, coming);
  return moved;
}

}  // namespace moraine::runtime
