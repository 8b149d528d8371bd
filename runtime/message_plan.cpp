// SPDX-License-Identifier: Apache-2.0
#include "runtime/message_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>

namespace moraine::runtime {
namespace {

/// Per stage, the stage that receives its messages, or none.
std::vector<int> receivers_of(std::span<const Stage> stages) {
  std::vector<int> receiver(stages.size(), Stage::none);
  for (std::size_t t = 0; t < stages.size(); ++t) {
    const int s = stages[t].receives;
    if (s == Stage::none) continue;
    if (s < 0 || s >= static_cast<int>(stages.size()))
      throw std::logic_error(fmt::format("stage {} receives from stage {}, which does not exist", stages[t].name, s));
    int& known = receiver[static_cast<std::size_t>(s)];
    if (known != Stage::none)
      throw std::logic_error(fmt::format("stages {} and {} both receive from {}",
                                         stages[static_cast<std::size_t>(known)].name, stages[t].name,
                                         stages[static_cast<std::size_t>(s)].name));
    known = static_cast<int>(t);
  }
  return receiver;
}

void check_ids(std::span<const SubModelId> ids, std::size_t size, const std::string& whose) {
  if (std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) != ids.end())
    throw std::logic_error(whose + " are not ascending");
  if (!ids.empty() && ids.back() >= size)
    throw std::logic_error(fmt::format("{} name sub-model {} of {}", whose, ids.back(), size));
}

bool contains(std::span<const SubModelId> ids, SubModelId id) { return std::binary_search(ids.begin(), ids.end(), id); }

/// Every source of `id` must list it among its targets. Messages from elsewhere are added to the plan.
void plan_sources(Model& model, SubModelId id, int stage, std::vector<Message>& plan) {
  const Stage& reading = model.stages()[static_cast<std::size_t>(stage)];
  const auto sources = model.sub_model(id).sources(stage);
  check_ids(sources, model.size(), fmt::format("sources of sub-model {} in stage {}", id, reading.name));
  if (reading.receives == Stage::none && !sources.empty())
    throw std::logic_error(
        fmt::format("sub-model {} has sources in stage {}, which receives nothing", id, reading.name));
  for (const SubModelId from : sources) {
    if (!model.placement().holds(from))
      plan.push_back({from, reading.receives, id, stage});
    else if (!contains(model.sub_model(from).targets(reading.receives), id))
      throw std::logic_error(fmt::format("stage {}: {} is a source of {}, but {} is not a target of {}", reading.name,
                                         from, id, id, from));
  }
}

/// Every target of `id` must list it among its sources; all are added to the plan.
void plan_targets(Model& model, SubModelId id, int stage, int read_in, std::vector<Message>& plan) {
  const Stage& sending = model.stages()[static_cast<std::size_t>(stage)];
  const auto targets = model.sub_model(id).targets(stage);
  check_ids(targets, model.size(), fmt::format("targets of sub-model {} in stage {}", id, sending.name));
  for (const SubModelId to : targets) {
    const bool expected =
        read_in != Stage::none && (!model.placement().holds(to) || contains(model.sub_model(to).sources(read_in), id));
    if (!expected)
      throw std::logic_error(
          fmt::format("stage {}: {} is a target of {}, but {} is not a source of {}", sending.name, to, id, id, to));
    plan.push_back({id, stage, to, read_in});
  }
}

}  // namespace

std::vector<Message> plan_messages(Model& model) {
  const std::vector<int> receiver = receivers_of(model.stages());
  std::vector<Message> plan;
  for (const SubModelId id : model.held()) {
    for (int stage = 0; stage < static_cast<int>(receiver.size()); ++stage) {
      plan_targets(model, id, stage, receiver[static_cast<std::size_t>(stage)], plan);
      plan_sources(model, id, stage, plan);
    }
  }
  std::sort(plan.begin(), plan.end());
  return plan;
}

}  // namespace moraine::runtime
