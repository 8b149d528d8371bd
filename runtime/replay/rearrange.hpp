// SPDX-License-Identifier: Apache-2.0
// The traced model repeated, or cut finer than it was.
#pragma once

#include <span>

#include "runtime/replay/workload.hpp"

namespace moraine::runtime {

/// The messages of an epoch of `copies` copies of the model in a row. Copy c has the sub-models c * n ... c * n + n
/// - 1. The last f of a copy are joined to the first f of the next one, in order, with the messages of a typical pair
/// of neighbours. f is the side of a cut in as many dimensions as the number of neighbours suggests: 1 for up to 2 of
/// them on average, the square root of n for up to 8, else n^(2/3). No neighbours: no joins.
std::vector<SizedMessage> side_by_side(const WorkEpoch& epoch, std::size_t sub_models, std::size_t copies);

/// The same work with every sub-model cut in `pieces` of equal size; sub-model s becomes s * pieces ... s * pieces +
/// pieces - 1, on the rank that owned s. `halo`: per sub-model, the share of its work that is for ghosts (0 ... 1); a
/// cut in d dimensions (as for side_by_side()) leaves a piece 1/pieces of the rest and pieces^(1/d - 1) of that. Pieces
/// of one are neighbours in a row. With d = 1 the first piece is the neighbour of what was before and the last of what
/// came after; else piece i of one is that of piece i of the other. Pieces take as long between epochs as what they are
/// pieces of. Errors: std::invalid_argument if pieces is 0 or `halo` has another length.
Workload cut_finer(const Workload& work, std::size_t pieces, std::span<const double> halo);

}  // namespace moraine::runtime
