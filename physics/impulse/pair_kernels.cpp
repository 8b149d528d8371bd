// SPDX-License-Identifier: Apache-2.0
#include "physics/impulse/pair_kernels.hpp"

#include <cstdlib>
#include <string_view>

#include "physics/impulse/pair_kernels_code.hpp"

namespace moraine::impulse {
namespace {

bool asked_for_portable() {
  const char* asked = std::getenv("MORAINE_SIMD");
  return asked != nullptr && std::string_view(asked) == "portable";
}

const PairKernels& choose_kernels() {
  const PairKernels* fast = asked_for_portable() ? nullptr : avx2_pair_kernels();
  return fast != nullptr ? *fast : portable_pair_kernels();
}

}  // namespace

const PairKernels& portable_pair_kernels() { return kernels_of_this_file; }

const PairKernels& pair_kernels() {
  static const PairKernels& chosen = choose_kernels();
  return chosen;
}

}  // namespace moraine::impulse
