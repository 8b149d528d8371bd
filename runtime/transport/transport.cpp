// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/transport.hpp"

#include "runtime/transport/loopback.hpp"

namespace moraine::runtime {

Transport& alone() {
  static const std::vector<std::unique_ptr<Transport>> ranks = make_loopback({.ranks = 1});
  return *ranks.front();
}

std::vector<Bytes> all_gather(Transport& transport, const Bytes& own) {
  return transport.exchange(std::vector<Bytes>(static_cast<std::size_t>(transport.ranks()), own));
}

std::vector<Bytes> gather(Transport& transport, int root, Bytes own) {
  std::vector<Bytes> to(static_cast<std::size_t>(transport.ranks()));
  to[static_cast<std::size_t>(root)] = std::move(own);
  std::vector<Bytes> from = transport.exchange(std::move(to));
  if (transport.rank() != root) from.clear();
  return from;
}

}  // namespace moraine::runtime
