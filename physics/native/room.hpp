// SPDX-License-Identifier: Apache-2.0
// Vectors that grow by a sixteenth: by themselves they double, and half of their memory is spare.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace moraine::native {

/// Memory for so many values, and a sixteenth more if there was too little.
template <class T>
void make_room(std::vector<T>& values, std::size_t count) {
  if (values.capacity() < count) values.reserve(count + count / 16);
}

/// As push_back().
template <class T>
void append(std::vector<T>& values, T value) {
  make_room(values, values.size() + 8);
  values.push_back(std::move(value));
}

/// At least so many values, as many as there is memory for.
template <class T>
void extend(std::vector<T>& values, std::size_t count) {
  if (values.size() >= count) return;
  make_room(values, count);
  values.resize(values.capacity());
}

}  // namespace moraine::native
