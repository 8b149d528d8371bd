// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/loopback.hpp"

#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <random>

namespace moraine::runtime {
namespace {

/// What has been sent to a rank, by sender. Shuffling asks a random sender first, and sometimes none.
class Inbox {
 public:
  Inbox(const LoopbackOptions& options, int rank)
      : queues_(static_cast<std::size_t>(options.ranks)),
        shuffled_(options.shuffled),
        random_(options.seed * 1'000'003 + static_cast<std::uint64_t>(rank)) {}

  void put(Parcel parcel) {
    const std::lock_guard lock(mutex_);
    queues_[static_cast<std::size_t>(parcel.from)].push_back(std::move(parcel));
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    for (auto& queue : queues_) queue.clear();
  }

  std::optional<Parcel> take() {
    const std::lock_guard lock(mutex_);
    if (shuffled_ && random_() % 3 == 0) return std::nullopt;
    const std::size_t first = shuffled_ ? random_() % queues_.size() : 0;
    for (std::size_t i = 0; i < queues_.size(); ++i)
      if (auto& queue = queues_[(first + i) % queues_.size()]; !queue.empty()) {
        Parcel parcel = std::move(queue.front());
        queue.pop_front();
        return parcel;
      }
    return std::nullopt;
  }

 private:
  std::mutex mutex_;
  std::vector<std::deque<Parcel>> queues_;
  bool shuffled_;
  std::mt19937_64 random_;
};

/// What all ranks share.
class Hub {
 public:
  explicit Hub(const LoopbackOptions& options) : offered_(static_cast<std::size_t>(options.ranks)) {
    for (int rank = 0; rank < options.ranks; ++rank) inboxes_.push_back(std::make_unique<Inbox>(options, rank));
  }

  int ranks() const { return static_cast<int>(inboxes_.size()); }
  Inbox& inbox(int rank) { return *inboxes_[static_cast<std::size_t>(rank)]; }

  std::vector<Bytes> exchange(int rank, std::vector<Bytes> to) {
    if (ranks() == 1) return to;
    const auto self = static_cast<std::size_t>(rank);
    offered_[self] = std::move(to);
    meet();
    std::vector<Bytes> from;
    for (auto& offer : offered_) from.push_back(std::move(offer[self]));
    meet();
    return from;
  }

 private:
  /// Nobody goes on before all have come.
  void meet() {
    std::unique_lock lock(mutex_);
    const std::uint64_t meeting = meeting_;
    if (++present_ == inboxes_.size()) {
      present_ = 0;
      ++meeting_;
      all_here_.notify_all();
    } else {
      all_here_.wait(lock, [&] { return meeting_ != meeting; });
    }
  }

  std::vector<std::unique_ptr<Inbox>> inboxes_;
  std::vector<std::vector<Bytes>> offered_;  ///< by rank that gives, then by rank that gets
  std::mutex mutex_;
  std::condition_variable all_here_;
  std::size_t present_ = 0;
  std::uint64_t meeting_ = 0;
};

class Loopback final : public Transport {
 public:
  Loopback(std::shared_ptr<Hub> hub, int rank) : hub_(std::move(hub)), rank_(rank) {}

  int rank() const override { return rank_; }
  int ranks() const override { return hub_->ranks(); }
  void send(int to, Bytes bytes) override { hub_->inbox(to).put({rank_, std::move(bytes)}); }
  std::optional<Parcel> receive() override { return hub_->inbox(rank_).take(); }
  std::vector<Bytes> all_gather(const Bytes& own) override {
    return exchange(std::vector<Bytes>(static_cast<std::size_t>(ranks()), own));
  }
  std::vector<Bytes> gather(int root, const Bytes& own) override {
    std::vector<Bytes> to(static_cast<std::size_t>(ranks()));
    to[static_cast<std::size_t>(root)] = own;
    std::vector<Bytes> from = exchange(std::move(to));
    if (rank_ != root) from.clear();
    return from;
  }
  std::vector<Bytes> exchange(std::vector<Bytes> to) override { return hub_->exchange(rank_, std::move(to)); }
  void drop_parcels() override {
    hub_->inbox(rank_).clear();
    all_gather({});  // nobody sends again before all have dropped
  }
  [[noreturn]] void abort(int status) override { std::_Exit(status); }
  int ranks_on_these_cores() override { return hub_->ranks(); }

 private:
  std::shared_ptr<Hub> hub_;
  int rank_;
};

}  // namespace

std::vector<std::unique_ptr<Transport>> make_loopback(const LoopbackOptions& options) {
  const auto hub = std::make_shared<Hub>(options);
  std::vector<std::unique_ptr<Transport>> ranks;
  for (int rank = 0; rank < options.ranks; ++rank) ranks.push_back(std::make_unique<Loopback>(hub, rank));
  return ranks;
}

}  // namespace moraine::runtime
