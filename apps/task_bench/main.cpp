// SPDX-License-Identifier: Apache-2.0
// task_bench: what a task costs. One line of JSON per system; under mpirun, our schedulers across ranks.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "metg.hpp"
#include "runtime/cores.hpp"
#include "runtime/records.hpp"
#include "runtime/transport/mpi_session.hpp"

namespace {

using namespace moraine::task_bench;
using moraine::runtime::Transport;

struct Choice {
  std::string pattern = "stencil", kernel = "fixed";
  std::vector<std::string> systems{"hybrid"};
  int threads = 1, repeats = 5;
  std::size_t width = 16;
  double seconds_per_iteration = 0;  ///< measured once: all systems then get the same problems
};

/// The same on every rank.
template <class Value, class Join>
Value joined(Transport& transport, Value own, const Join& join) {
  moraine::runtime::Bytes told;
  moraine::runtime::write_records(told, std::vector{own});
  const auto all = transport.all_gather(told);
  std::vector<Value> values;
  for (std::span<const std::byte> in : all) values.push_back(moraine::runtime::read_records<Value>(in).at(0));
  Value out = values[0];
  for (std::size_t i = 1; i < values.size(); ++i) out = join(out, values[i]);
  return out;
}

Outcome run(const Problem& problem, const std::string& system, int threads, Transport& transport) {
  if (system == "tbb_flow_graph") return run_flow_graph(problem, threads);
  if (system == "openmp_tasks") return run_openmp(problem, threads);
  const Outcome own = run_moraine(problem, system, threads, transport);
  return joined(transport, own, [](const Outcome& a, const Outcome& b) {
    return Outcome{std::max(a.seconds, b.seconds), a.checksum + b.checksum};
  });
}

Measurement measurement(const Choice& choice, const std::string& system, Transport& transport) {
  Measurement m;
  m.problem.graph = make_graph(choice.pattern, choice.width);
  m.problem.kernel = find_kernel(choice.kernel);
  m.seconds_per_iteration = choice.seconds_per_iteration;
  m.cores = std::min(choice.threads * transport.ranks(), moraine::runtime::usable_cores());
  m.repeats = choice.repeats;
  m.run = [&choice, &transport, system](const Problem& p) { return run(p, system, choice.threads, transport); };
  return m;
}

nlohmann::json measured(const Choice& choice, const std::string& system, Transport& transport) {
  const Measurement m = measurement(choice, system, transport);
  nlohmann::json line{{"pattern", choice.pattern},  {"kernel", choice.kernel},   {"system", system},
                      {"ranks", transport.ranks()}, {"threads", choice.threads}, {"cores", m.cores}};
  if (m.problem.kernel == Kernel::empty) {
    line["overhead_us"] = 1e6 * overhead(m);
    return line;
  }
  const Sweep sizes = sweep(m);
  for (const Size& s : sizes) line["sizes"].push_back({s.iterations, 1e6 * s.task_seconds, s.efficiency, s.checksum});
  if (const auto found = metg(sizes)) line["metg_us"] = 1e6 * *found;
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"What a task costs, in the manner of Task Bench: METG(50 %), or the time of empty tasks."};
  Choice choice;
  app.add_option("--pattern", choice.pattern, "trivial, stencil, tree or random")->capture_default_str();
  app.add_option("--kernel", choice.kernel, "empty, fixed or imbalanced")->capture_default_str();
  app.add_option("--system", choice.systems, "our schedulers, tbb_flow_graph, openmp_tasks")->delimiter(',');
  app.add_option("--threads", choice.threads, "of each rank")->check(CLI::PositiveNumber);
  app.add_option("--width", choice.width, "points")->check(CLI::PositiveNumber);
  app.add_option("--repeats", choice.repeats, "runs of each size")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  moraine::runtime::MpiSession session;
  try {
    const auto lesser = [](double a, double b) { return std::min(a, b); };
    choice.seconds_per_iteration = joined(session.transport(), seconds_per_iteration(choice.threads), lesser);
    for (const std::string& system : choice.systems) {
      const nlohmann::json line = measured(choice, system, session.transport());
      if (session.transport().rank() == 0) std::cout << line << std::endl;
    }
  } catch (const std::exception& e) {
    std::cerr << "task_bench: " << e.what() << '\n';
    session.transport().abort(2);
  }
}
