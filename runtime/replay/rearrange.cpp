// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/rearrange.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

namespace moraine::runtime {
namespace {

/// Messages between a pair of neighbours, as if these were 0 and 1.
using PairMessages = std::vector<SizedMessage>;

std::vector<PairMessages> pairs_of(const WorkEpoch& epoch) {
  std::map<std::pair<SubModelId, SubModelId>, PairMessages> pairs;
  for (const SizedMessage& m : epoch.messages) {
    const auto [low, high] = std::minmax(m.message.from, m.message.to);
    if (low == high) continue;
    SizedMessage generic = m;
    generic.message.from = m.message.from == low ? 0 : 1;
    generic.message.to = 1 - generic.message.from;
    pairs[{low, high}].push_back(generic);
  }
  std::vector<PairMessages> out;
  for (auto& [pair, messages] : pairs) out.push_back(std::move(messages));
  return out;
}

double bytes_of(const PairMessages& pair) {
  return std::accumulate(pair.begin(), pair.end(), 0.0,
                         [](double sum, const SizedMessage& m) { return sum + m.bytes; });
}

/// Of a cut into sub-models that have so many neighbours.
int dimensions(std::size_t sub_models, std::size_t pairs) {
  const double neighbours = 2 * static_cast<double>(pairs) / static_cast<double>(sub_models);
  return neighbours <= 2 ? 1 : neighbours <= 8 ? 2 : 3;
}

/// Sub-models at a side of the cut.
std::size_t face(std::size_t sub_models, std::size_t pairs) {
  const double d = dimensions(sub_models, pairs);
  const double side = std::pow(static_cast<double>(sub_models), 1 - 1 / d);
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(side)), 1, sub_models);
}

const PairMessages& typical(std::vector<PairMessages>& pairs) {
  const auto middle = pairs.begin() + static_cast<std::ptrdiff_t>(pairs.size() / 2);
  std::ranges::nth_element(pairs, middle, {}, bytes_of);
  return *middle;
}

/// Adds the messages of `pair` between `first` and `second`.
void join(const PairMessages& pair, SubModelId first, SubModelId second, std::vector<SizedMessage>& out) {
  const std::array ends{first, second};
  for (SizedMessage m : pair) {
    m.message.from = ends[m.message.from];
    m.message.to = ends[m.message.to];
    out.push_back(m);
  }
}

/// Both ways, for every stage that receives: what neighbours may send if there are none to learn from.
PairMessages any_pair(const TraceSettings& settings) {
  PairMessages out;
  for (std::size_t stage = 0; stage < settings.receives.size(); ++stage)
    for (const SubModelId from : {0U, 1U})
      if (const int sent_in = settings.receives[stage]; sent_in >= 0)
        out.push_back({{from, sent_in, 1 - from, static_cast<int>(stage)}, 0.0});
  return out;
}

/// Sub-models in pieces.
class FinerCut {
 public:
  FinerCut(const Workload& work, std::size_t pieces, std::span<const double> halo)
      : work_(work), pieces_(pieces), halo_(halo) {}

  WorkEpoch cut(const WorkEpoch& epoch) {
    std::vector<PairMessages> pairs = pairs_of(epoch);
    dimensions_ = dimensions(work_.sub_models, pairs.size());
    surface_ = std::pow(static_cast<double>(pieces_), 1.0 / dimensions_ - 1);
    WorkEpoch out{.span = epoch.span,
                  .messages = messages(epoch, pairs),
                  .cost = nodes(epoch.cost),
                  .memory = {},
                  .seconds = nodes(epoch.seconds),
                  .owner = {},
                  .between = epoch.between,
                  .moving = epoch.moving,
                  .traced_seconds = epoch.traced_seconds};
    for (std::size_t s = 0; s < work_.sub_models; ++s) {
      out.memory.insert(out.memory.end(), pieces_, epoch.memory[s] * share(s));
      out.owner.insert(out.owner.end(), pieces_, epoch.owner[s]);
    }
    for (const Phase p : {Phase::settle, Phase::plan}) out.between.phase[static_cast<std::size_t>(p)] *= grown();
    return out;
  }

 private:
  /// Of a sub-model's work, that of one of its pieces.
  double share(std::size_t sub_model) const {
    return (1 - halo_[sub_model]) / static_cast<double>(pieces_) + halo_[sub_model] * surface_;
  }

  /// Of all of them together: neighbours and plans cost what there are of them.
  double grown() const {
    double sum = 0;
    for (std::size_t s = 0; s < work_.sub_models; ++s) sum += share(s);
    return sum * static_cast<double>(pieces_) / static_cast<double>(work_.sub_models);
  }

  /// Values of nodes, for one round or several.
  std::vector<double> nodes(const std::vector<double>& values) const {
    std::vector<double> out;
    const auto stages = static_cast<std::ptrdiff_t>(work_.stages());
    for (auto at = values.begin(); at != values.end(); at += stages) {
      const std::size_t sub_model = static_cast<std::size_t>((at - values.begin()) / stages) % work_.sub_models;
      for (std::size_t piece = 0; piece < pieces_; ++piece)
        std::transform(at, at + stages, std::back_inserter(out), [&](double v) { return v * share(sub_model); });
    }
    return out;
  }

  std::vector<SizedMessage> messages(const WorkEpoch& epoch, std::vector<PairMessages>& pairs) const {
    std::vector<SizedMessage> out;
    for (const SizedMessage& m : epoch.messages) spread(m, out);
    const PairMessages inside = pairs.empty() ? any_pair(work_.settings) : typical(pairs);
    for (std::size_t s = 0; s < work_.sub_models; ++s)
      for (std::size_t piece = 0; piece + 1 < pieces_; ++piece) join(inside, at(s, piece), at(s, piece + 1), out);
    std::ranges::sort(out, {}, &SizedMessage::message);
    return out;
  }

  void spread(SizedMessage m, std::vector<SizedMessage>& out) const {
    const SubModelId from = m.message.from, to = m.message.to;
    if (dimensions_ > 1 || from == to) m.bytes *= surface_;
    for (std::size_t piece = 0; piece < pieces_; ++piece) {
      const bool in_row = dimensions_ == 1 && from != to;
      m.message.from = at(from, !in_row ? piece : from < to ? pieces_ - 1 : 0);
      m.message.to = at(to, !in_row ? piece : from < to ? 0 : pieces_ - 1);
      out.push_back(m);
      if (in_row) return;
    }
  }

  SubModelId at(std::size_t sub_model, std::size_t piece) const {
    return static_cast<SubModelId>(sub_model * pieces_ + piece);
  }

  const Workload& work_;
  std::size_t pieces_;
  std::span<const double> halo_;
  int dimensions_ = 1;
  double surface_ = 1;  ///< of a piece's ghosts, relative to those of the whole
};

}  // namespace

std::vector<SizedMessage> side_by_side(const WorkEpoch& epoch, std::size_t sub_models, std::size_t copies) {
  std::vector<SizedMessage> out;
  for (std::size_t c = 0; c < copies; ++c)
    for (SizedMessage m : epoch.messages) {
      m.message.from += static_cast<SubModelId>(c * sub_models);
      m.message.to += static_cast<SubModelId>(c * sub_models);
      out.push_back(m);
    }
  std::vector<PairMessages> pairs = pairs_of(epoch);
  if (copies == 1 || pairs.empty()) return out;
  const std::size_t joined = face(sub_models, pairs.size());
  const PairMessages& pair = typical(pairs);
  for (std::size_t c = 0; c + 1 < copies; ++c)
    for (std::size_t i = 0; i < joined; ++i)
      join(pair, static_cast<SubModelId>((c + 1) * sub_models - joined + i),
           static_cast<SubModelId>((c + 1) * sub_models + i), out);
  std::ranges::sort(out, {}, &SizedMessage::message);
  return out;
}

Workload cut_finer(const Workload& work, std::size_t pieces, std::span<const double> halo) {
  if (pieces == 0) throw std::invalid_argument("a sub-model is cut into 1 piece or more");
  if (halo.size() != work.sub_models) throw std::invalid_argument("a share of ghosts is needed for each sub-model");
  FinerCut cut(work, pieces, halo);
  Workload out{.settings = work.settings,
               .sub_models = work.sub_models * pieces,
               .epochs = {},
               .overheads = work.overheads,
               .traced_makespan = work.traced_makespan};
  out.settings.sub_models = static_cast<std::int64_t>(out.sub_models);
  for (const WorkEpoch& epoch : work.epochs) out.epochs.push_back(cut.cut(epoch));
  return out;
}

}  // namespace moraine::runtime
