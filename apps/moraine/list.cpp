// SPDX-License-Identifier: Apache-2.0
// moraine list: the tables of everything that can be chosen by name.
#include <fmt/format.h>

#include <iostream>

#include "commands.hpp"
#include "ghosting/coupling.hpp"
#include "ghosting/guards.hpp"
#include "ghosting/split.hpp"
#include "output/writer.hpp"
#include "physics/world.hpp"
#include "runtime/balance/load_model.hpp"
#include "runtime/balance/registry.hpp"
#include "runtime/schedule/registry.hpp"

namespace moraine::app {
namespace {

template <class Rows>
void print(const char* title, const Rows& rows) {
  std::cout << title << '\n';
  for (const auto& row : rows) std::cout << fmt::format("  {:<14} {}\n", row.name, row.help);
}

}  // namespace

int list() {
  print("engines", engines());
  print("splits", splits());
  print("couplings", couplings());
  print("schedulers", runtime::schedulers());
  print("balancers", runtime::balancers());
  print("load predictions", runtime::predictors());
  print("output formats", writers());
  print("guards", guards());
  return 0;
}

}  // namespace moraine::app
