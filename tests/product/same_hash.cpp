// SPDX-License-Identifier: Apache-2.0
// same_hash: one scene on ranks that are threads of this process, in every combination of ranks, threads, schedulers,
// balancers and order of delivery. One line of JSON per run; status 1 if they do not all have the hash of one rank with
// one thread. See tools/one_answer.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "runtime/balance/registry.hpp"
#include "runtime/schedule/registry.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/rank_run.hpp"

namespace {

using namespace moraine;

template <class Row>
std::vector<std::string> names(std::span<const Row> rows) {
  std::vector<std::string> all;
  for (const Row& row : rows) all.emplace_back(row.name);
  return all;
}

struct Choice {
  std::string scene;
  std::vector<std::string> sets;
  std::vector<int> ranks{1, 2, 3, 4}, threads{1, 2};
  std::vector<std::string> schedulers = names(runtime::schedulers()), balancers = names(runtime::balancers());
  std::vector<std::uint64_t> seeds{0, 1};
};

struct Setup {
  int ranks = 1, threads = 1;
  std::string scheduler = "serial", balancer = "none";
  std::uint64_t seed = 0;  ///< of shuffled delivery; 0: in order
};

struct Outcome {
  std::string hash;
  std::int64_t migrations = 0;
};

/// Owners at random, for replay.
std::vector<runtime::Owners> random_plans(std::size_t sub_models, int ranks) {
  std::mt19937 random(static_cast<unsigned>(sub_models) * 31U + static_cast<unsigned>(ranks));
  std::vector<runtime::Owners> plans(20, runtime::Owners(sub_models));
  for (runtime::Owners& plan : plans)
    for (int& owner : plan) owner = static_cast<int>(random() % static_cast<unsigned>(ranks));
  return plans;
}

Outcome run(const Scene& scene, const Setup& setup) {
  Outcome outcome;
  const runtime::LoopbackOptions loopback{.ranks = setup.ranks, .shuffled = setup.seed > 0, .seed = setup.seed};
  test::on_ranks(loopback, [&](runtime::Transport& transport) {
    CoupledModel model(scene, transport);
    runtime::Options options{
        .threads = setup.threads, .scheduler = setup.scheduler, .check_messages = true, .transport = &transport};
    options.balance.balancer = setup.balancer;
    options.balance.measured = scene.run.balance_measured;
    options.balance.more.plans = random_plans(model.size(), setup.ranks);
    runtime::Simulation simulation(model, options);
    simulation.run(0, scene.time.steps * scene.time.substeps);
    const std::vector<ElementState> states = model.states(0);
    if (transport.rank() == 0)
      outcome = {fmt::format("{:016x}", state_hash(scene, states)), simulation.balance().migrations()};
  });
  return outcome;
}

std::vector<Setup> product(const Choice& c) {
  std::vector<Setup> all;
  for (const int ranks : c.ranks)
    for (const int threads : c.threads)
      for (const std::string& scheduler : c.schedulers)
        for (const std::string& balancer : c.balancers)
          for (const std::uint64_t seed : c.seeds) {
            if (ranks == 1 && (balancer != c.balancers.front() || seed != c.seeds.front())) continue;  // nothing to do
            all.push_back({ranks, threads, scheduler, balancer, seed});
          }
  return all;
}

Scene scene_of(const Choice& choice) {
  std::vector<Override> overrides;
  for (const std::string& s : choice.sets) {
    const auto at = s.find('=');
    if (at == std::string::npos) throw InputError("--set " + s + ": expected key=value");
    overrides.push_back({s.substr(0, at), s.substr(at + 1)});
  }
  return read_scene(choice.scene, overrides);
}

/// Number of runs that differ.
int compare(const Choice& choice) {
  const Scene scene = scene_of(choice);
  const std::string alone = run(scene, {}).hash;
  const std::vector<Setup> setups = product(choice);
  int different = 0;
  for (const Setup& s : setups) {
    const Outcome o = run(scene, s);
    different += o.hash != alone;
    std::cout << nlohmann::json{{"ranks", s.ranks},       {"threads", s.threads},   {"scheduler", s.scheduler},
                                {"balancer", s.balancer}, {"shuffled", s.seed > 0}, {"migrations", o.migrations},
                                {"state_hash", o.hash},   {"same", o.hash == alone}}
              << std::endl;
  }
  return different;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"One scene in every combination of ranks, threads, schedulers, balancers and order of delivery."};
  Choice choice;
  app.add_option("scene", choice.scene, "scene file")->required();
  app.add_option("--set", choice.sets, "key=value, as for moraine run; may be repeated")->take_all()->expected(1);
  app.add_option("--ranks", choice.ranks, "default 1,2,3,4")->delimiter(',');
  app.add_option("--threads", choice.threads, "of each rank; default 1,2")->delimiter(',');
  app.add_option("--schedulers", choice.schedulers, "default: all")->delimiter(',');
  app.add_option("--balancers", choice.balancers, "default: all")->delimiter(',');
  app.add_option("--seeds", choice.seeds, "of shuffled delivery, 0: in order; default 0,1")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  try {
    return compare(choice) > 0 ? 1 : 0;
  } catch (const std::exception& e) {
    std::cerr << "same_hash: " << e.what() << '\n';
    return 2;
  }
}
