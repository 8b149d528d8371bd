// SPDX-License-Identifier: Apache-2.0
// Invariants of the coupling, checked between epochs in checking builds and by the tests.
#pragma once

namespace moraine {

class CoupledModel;

/// Every element owned once; ghost lists of host and owner equal; every ghost's owner is its element's; the loads
/// copies carry sum to nothing. Errors: std::logic_error naming what is broken. Cost: linear in elements and ghosts.
void verify_invariants(const CoupledModel& model);

#ifdef MORAINE_CHECKS
inline void check_invariants(const CoupledModel& model) { verify_invariants(model); }
#else
inline void check_invariants(const CoupledModel&) {}
#endif

}  // namespace moraine
