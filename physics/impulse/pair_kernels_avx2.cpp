// SPDX-License-Identifier: Apache-2.0
// Compiled with -mavx2 where the processor's family has it.
#if defined(__AVX2__)

#include "physics/impulse/pair_kernels_code.hpp"

namespace moraine::impulse {

const PairKernels* avx2_pair_kernels() { return __builtin_cpu_supports("avx2") ? &kernels_of_this_file : nullptr; }

}  // namespace moraine::impulse

#else

#include "physics/impulse/pair_kernels.hpp"

namespace moraine::impulse {

const PairKernels* avx2_pair_kernels() { return nullptr; }

}  // namespace moraine::impulse

#endif
