// SPDX-License-Identifier: Apache-2.0
// moraine render: pictures of the frames that a run left behind.
#include <fmt/format.h>

#include <iostream>

#include "commands.hpp"
#include "output/picture.hpp"
#include "output/read_frames.hpp"

namespace moraine::app {

int render(const std::filesystem::path& folder, int width) {
  const RecordedRun run(folder);
  for (std::size_t i = 0; i < run.size(); ++i) {
    const Frame frame = run.frame(i);
    const std::filesystem::path path = folder / "frames" / fmt::format("picture_{:06}.png", frame.step);
    write_picture(run.scene(), frame, path, width);
    std::cout << path.string() << '\n';
  }
  return 0;
}

}  // namespace moraine::app
