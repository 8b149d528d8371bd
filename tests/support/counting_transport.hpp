// SPDX-License-Identifier: Apache-2.0
// Counts what really leaves a rank.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <utility>

#include "runtime/transport/envelope.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime::test {

struct Sent {
  std::int64_t parcels = 0;
  std::uint64_t bytes = 0;  ///< with envelopes
  bool operator==(const Sent&) const = default;
};

/// Hands everything on, and counts parcels between the ranks' sub-models once told to.
class CountingTransport final : public Transport {
 public:
  explicit CountingTransport(Transport& inner) : inner_(inner) {}

  void start() { counting_ = true; }
  /// By receiving rank.
  const std::map<int, Sent>& to_ranks() const { return to_ranks_; }
  /// By sending and receiving sub-model.
  const std::map<std::pair<SubModelId, SubModelId>, Sent>& by_sub_models() const { return by_sub_models_; }
  std::int64_t collectives() const { return collectives_; }

  int rank() const override { return inner_.rank(); }
  int ranks() const override { return inner_.ranks(); }
  void send(int to, Bytes bytes) override {
    if (counting_) count(to, {rank(), bytes});
    inner_.send(to, std::move(bytes));
  }
  std::optional<Parcel> receive() override { return inner_.receive(); }
  std::vector<Bytes> all_gather(const Bytes& own) override {
    collectives_ += counting_;
    return inner_.all_gather(own);
  }
  std::vector<Bytes> gather(int root, const Bytes& own) override {
    collectives_ += counting_;
    return inner_.gather(root, own);
  }
  std::vector<Bytes> exchange(std::vector<Bytes> to) override {
    collectives_ += counting_;
    return inner_.exchange(std::move(to));
  }
  void drop_parcels() override { inner_.drop_parcels(); }
  [[noreturn]] void abort(int status) override {
    inner_.abort(status);
    std::terminate();  // not reached
  }
  int ranks_on_these_cores() override { return inner_.ranks_on_these_cores(); }

 private:
  void count(int to, const Parcel& parcel) {
    const Envelope envelope = unpack(parcel).envelope;
    const std::lock_guard lock(mutex_);
    for (Sent* sent : {&to_ranks_[to], &by_sub_models_[{envelope.from, envelope.to}]}) {
      ++sent->parcels;
      sent->bytes += parcel.bytes.size();
    }
  }

  Transport& inner_;
  std::atomic<bool> counting_ = false;
  std::atomic<std::int64_t> collectives_ = 0;
  std::mutex mutex_;
  std::map<int, Sent> to_ranks_;
  std::map<std::pair<SubModelId, SubModelId>, Sent> by_sub_models_;
};

}  // namespace moraine::runtime::test
