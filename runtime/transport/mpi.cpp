// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/mpi.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <list>
#include <mutex>
#include <numeric>
#include <stdexcept>

namespace moraine::runtime {
namespace {

constexpr int parcel_tag = 1;
constexpr int exchange_tag = 2;
constexpr std::size_t piece = std::size_t{1} << 30;  // MPI counts in int: longer blocks travel in pieces

void check_thread_level() {
  int level = MPI_THREAD_SINGLE;
  MPI_Query_thread(&level);
  if (level < MPI_THREAD_SERIALIZED)
    throw std::runtime_error(fmt::format("MPI gives thread level {}, at least {} (MPI_THREAD_SERIALIZED) is needed",
                                         level, static_cast<int>(MPI_THREAD_SERIALIZED)));
}

/// Duplicates of the host's communicator.
class Communicator {
 public:
  explicit Communicator(MPI_Comm original) { MPI_Comm_dup(original, &handle_); }
  ~Communicator() { MPI_Comm_free(&handle_); }
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  MPI_Comm get() const { return handle_; }

 private:
  MPI_Comm handle_ = MPI_COMM_NULL;
};

/// What is collected of every rank's block at once: as much as MPI can count, hence nearly always all.
struct Portion {
  Portion(const std::vector<std::uint64_t>& sizes, std::uint64_t at, std::uint64_t most) : places(sizes.size() + 1) {
    for (const std::uint64_t size : sizes)
      counts.push_back(static_cast<int>(std::min(size - std::min(at, size), most)));
    std::partial_sum(counts.begin(), counts.end(), places.begin() + 1);
  }
  std::size_t length() const { return static_cast<std::size_t>(places.back()); }
  void append(Bytes& to, const Bytes& taken, std::size_t rank) const {
    to.insert(to.end(), taken.begin() + places[rank], taken.begin() + places[rank + 1]);
  }

  std::vector<int> counts;  ///< per rank
  std::vector<int> places;  ///< per rank, and the end
};

/// Blocks in pieces that MPI can count, begun one after another and awaited together.
class Transfers {
 public:
  explicit Transfers(MPI_Comm communicator) : communicator_(communicator) {}

  void send(int to, const Bytes& block) {
    each_piece(block.size(), [&](std::size_t at, int count) {
      MPI_Isend(block.data() + at, count, MPI_BYTE, to, exchange_tag, communicator_, &begin());
    });
  }
  void receive(int from, Bytes& block) {
    each_piece(block.size(), [&](std::size_t at, int count) {
      MPI_Irecv(block.data() + at, count, MPI_BYTE, from, exchange_tag, communicator_, &begin());
    });
  }
  void wait() { MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE); }

 private:
  MPI_Request& begin() { return requests_.emplace_back(MPI_REQUEST_NULL); }

  template <class Function>
  static void each_piece(std::size_t size, const Function& function) {
    for (std::size_t at = 0; at < size; at += piece) function(at, static_cast<int>(std::min(piece, size - at)));
  }

  MPI_Comm communicator_;
  std::vector<MPI_Request> requests_;
};

class Mpi final : public Transport {
 public:
  explicit Mpi(MPI_Comm communicator) : parcels_(communicator), exchanges_(communicator) {
    MPI_Comm_rank(parcels_.get(), &rank_);
    MPI_Comm_size(parcels_.get(), &ranks_);
    sent_to_.resize(static_cast<std::size_t>(ranks_));
    received_from_.resize(static_cast<std::size_t>(ranks_));
  }
  ~Mpi() override {
    for (Outgoing& o : outgoing_) MPI_Wait(&o.request, MPI_STATUS_IGNORE);
  }

  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }

  void send(int to, Bytes bytes) override {
    if (bytes.size() > piece) throw std::length_error("a message between ranks is longer than 1 GiB");
    const std::lock_guard lock(mutex_);
    Outgoing& o = outgoing_.emplace_back();
    o.bytes = std::move(bytes);
    ++sent_to_[static_cast<std::size_t>(to)];
    MPI_Isend(o.bytes.data(), static_cast<int>(o.bytes.size()), MPI_BYTE, to, parcel_tag, parcels_.get(), &o.request);
  }

  std::optional<Parcel> receive() override {
    const std::lock_guard lock(mutex_);
    outgoing_.remove_if([](Outgoing& o) { return is_gone(o); });
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    int found = 0;
    MPI_Improbe(MPI_ANY_SOURCE, parcel_tag, parcels_.get(), &found, &message, &status);
    if (found == 0) return std::nullopt;
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    Parcel parcel{status.MPI_SOURCE, Bytes(static_cast<std::size_t>(count))};
    MPI_Mrecv(parcel.bytes.data(), count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
    ++received_from_[static_cast<std::size_t>(parcel.from)];
    return parcel;
  }

  std::vector<Bytes> all_gather(const Bytes& own) override {
    return in_portions(own, true, [this](const std::byte* give, std::byte* take, const Portion& portion) {
      MPI_Allgatherv(give, portion.counts[static_cast<std::size_t>(rank_)], MPI_BYTE, take, portion.counts.data(),
                     portion.places.data(), MPI_BYTE, exchanges_.get());
    });
  }

  std::vector<Bytes> gather(int root, const Bytes& own) override {
    return in_portions(own, rank_ == root,
                       [this, root](const std::byte* give, std::byte* take, const Portion& portion) {
                         MPI_Gatherv(give, portion.counts[static_cast<std::size_t>(rank_)], MPI_BYTE, take,
                                     portion.counts.data(), portion.places.data(), MPI_BYTE, root, exchanges_.get());
                       });
  }

  std::vector<Bytes> exchange(std::vector<Bytes> to) override {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint64_t> given, taken(to.size());
    for (const Bytes& block : to) given.push_back(block.size());
    MPI_Alltoall(given.data(), 1, MPI_UINT64_T, taken.data(), 1, MPI_UINT64_T, exchanges_.get());
    std::vector<Bytes> from;
    for (const std::uint64_t size : taken) from.emplace_back(size);
    Transfers transfers(exchanges_.get());
    for (int other = 0; other < ranks_; ++other) {
      transfers.receive(other, from[static_cast<std::size_t>(other)]);
      transfers.send(other, to[static_cast<std::size_t>(other)]);
    }
    transfers.wait();
    return from;
  }

  void drop_parcels() override {
    std::vector<std::uint64_t> coming(sent_to_.size());
    {
      const std::lock_guard lock(mutex_);
      MPI_Alltoall(sent_to_.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, exchanges_.get());
    }
    while (received_from_ != coming) receive();
    const std::lock_guard lock(mutex_);
    MPI_Barrier(exchanges_.get());  // nobody sends again before all have dropped
  }

  [[noreturn]] void abort(int status) override {
    MPI_Abort(parcels_.get(), status);
    std::_Exit(status);
  }

  /// Cores are compared as the operating system numbers them, among the ranks that share this machine's memory.
  int ranks_on_these_cores() override {
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(exchanges_.get(), MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
    int count = 0;
    MPI_Comm_size(here, &count);
    cpu_set_t own;
    CPU_ZERO(&own);
    sched_getaffinity(0, sizeof own, &own);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(count));
    MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, here);
    MPI_Comm_free(&here);
    return static_cast<int>(std::count_if(all.begin(), all.end(), [&](const cpu_set_t& other) {
      cpu_set_t both;
      CPU_AND(&both, &own, &other);
      return CPU_COUNT(&both) > 0;
    }));
  }

 private:
  struct Outgoing {
    Bytes bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  /// Blocks of all ranks, collected `here` and in the same number of portions everywhere.
  template <class Collect>
  std::vector<Bytes> in_portions(const Bytes& own, bool here, const Collect& collect) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t size = own.size();
    std::vector<std::uint64_t> sizes(static_cast<std::size_t>(ranks_));
    MPI_Allgather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, exchanges_.get());
    std::vector<Bytes> all(here ? sizes.size() : 0);
    const std::uint64_t longest = *std::max_element(sizes.begin(), sizes.end()), most = piece / sizes.size();
    for (std::uint64_t at = 0; at < longest; at += most) {
      const Portion portion(sizes, at, most);
      Bytes taken(here ? portion.length() : 0);
      collect(own.data() + std::min(at, size), taken.data(), portion);
      for (std::size_t rank = 0; rank < all.size(); ++rank) portion.append(all[rank], taken, rank);
    }
    return all;
  }

  static bool is_gone(Outgoing& o) {
    int done = 0;
    MPI_Test(&o.request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  }

  Communicator parcels_, exchanges_;
  int rank_ = 0, ranks_ = 1;
  std::mutex mutex_;                                    ///< MPI is called by one thread at a time
  std::list<Outgoing> outgoing_;                        ///< until MPI has them
  std::vector<std::uint64_t> sent_to_, received_from_;  ///< parcels, by rank
};

}  // namespace

std::unique_ptr<Transport> make_mpi(MPI_Comm communicator) {
  check_thread_level();
  return std::make_unique<Mpi>(communicator);
}

}  // namespace moraine::runtime
