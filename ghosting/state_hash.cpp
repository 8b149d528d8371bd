// SPDX-License-Identifier: Apache-2.0
#include "ghosting/state_hash.hpp"

#include <xxhash.h>

#include <array>
#include <memory>

namespace moraine {

std::uint64_t state_hash(const Scene& scene, std::span<const ElementState> states) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> hash(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(hash.get());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Vec3 &x = states[i].pose.position, &v = states[i].twist.linear, &w = states[i].twist.angular;
    const Quat& q = states[i].pose.orientation;
    const std::array<double, 14> row{static_cast<double>(scene.elements[i].id),
                                     x.x(),
                                     x.y(),
                                     x.z(),
                                     q.w(),
                                     q.x(),
                                     q.y(),
                                     q.z(),
                                     v.x(),
                                     v.y(),
                                     v.z(),
                                     w.x(),
                                     w.y(),
                                     w.z()};
    XXH3_64bits_update(hash.get(), row.data(), sizeof row);
  }
  return XXH3_64bits_digest(hash.get());
}

}  // namespace moraine
