// SPDX-License-Identifier: Apache-2.0
#include "ghosting/collect.hpp"

#include "runtime/records.hpp"

namespace moraine {

std::vector<runtime::Bytes> collect(const runtime::Model& model, runtime::Transport& transport,
                                    const std::function<runtime::Bytes(SubModelId)>& give, std::optional<int> root) {
  runtime::Bytes own;
  for (SubModelId id = 0; id < model.size(); ++id) {
    if (!model.placement().holds(id)) continue;
    runtime::write_records(own, std::vector{id});
    runtime::write_records(own, give(id));
  }
  const bool here = !root || *root == transport.rank();
  std::vector<runtime::Bytes> all(here ? model.size() : 0);
  const std::vector<runtime::Bytes> parts = root ? transport.gather(*root, own) : transport.all_gather(own);
  for (const runtime::Bytes& part : parts)
    for (std::span<const std::byte> in(part); !in.empty();) {
      const SubModelId id = runtime::read_records<SubModelId>(in).at(0);
      all.at(id) = runtime::read_records<std::byte>(in);
    }
  return all;
}

}  // namespace moraine
