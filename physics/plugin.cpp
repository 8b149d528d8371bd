// SPDX-License-Identifier: Apache-2.0
#include "physics/plugin.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "physics/errors.hpp"

namespace moraine {

namespace fs = std::filesystem;

std::vector<fs::path> plugin_places(std::string_view engine) {
  const fs::path file = fmt::format("moraine_{}.so", engine);
  if (const char* folder = std::getenv("MORAINE_ENGINES")) return {folder / file};
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  return {here / file, here / "lib/moraine" / file, here.parent_path() / "lib/moraine" / file};
}

std::optional<fs::path> find_plugin(std::string_view engine) {
  const std::vector<fs::path> places = plugin_places(engine);
  const auto found = std::find_if(places.begin(), places.end(), [](const fs::path& p) { return fs::exists(p); });
  return found == places.end() ? std::nullopt : std::optional(*found);
}

MakeWorld load_plugin(std::string_view engine) {
  const std::optional<fs::path> found = find_plugin(engine);
  if (!found) {
    std::string looked;
    for (const fs::path& p : plugin_places(engine)) looked += "\n  " + p.string();
    throw IoError(fmt::format("the library of engine {} is missing; looked for{}", engine, looked));
  }
  void* library = dlopen(found->c_str(), RTLD_NOW | RTLD_LOCAL);
  void* make = library ? dlsym(library, "moraine_make_world") : nullptr;
  if (!make) throw IoError(fmt::format("the library of engine {} cannot be used: {}", engine, dlerror()));
  return reinterpret_cast<MakeWorld>(make);
}

}  // namespace moraine
