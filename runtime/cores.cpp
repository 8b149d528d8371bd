// SPDX-License-Identifier: Apache-2.0
#include "runtime/cores.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

namespace moraine::runtime {
namespace {

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();

double bound_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return CPU_COUNT(&set);
  return std::max(1U, std::thread::hardware_concurrency());
}

double ratio(double quota, double period) { return quota > 0 && period > 0 ? quota / period : unlimited; }

/// Version 2: "quota period", or "max period".
double quota_v2(const fs::path& group) {
  std::ifstream file(group / "cpu.max");
  double quota = 0;
  double period = 0;
  return file >> quota >> period ? ratio(quota, period) : unlimited;
}

/// Version 1: two files; a quota of -1 is none.
double quota_v1(const fs::path& group) {
  std::ifstream quota_file(group / "cpu.cfs_quota_us");
  std::ifstream period_file(group / "cpu.cfs_period_us");
  double quota = 0;
  double period = 0;
  return quota_file >> quota && period_file >> period ? ratio(quota, period) : unlimited;
}

/// The least quota of a group and all it is in. Inside a container the group may be unknown by its outer name.
double least_quota(const fs::path& mount, fs::path group, double (*quota)(const fs::path&)) {
  double least = quota(mount);
  for (; group.has_relative_path(); group = group.parent_path())
    least = std::min(least, quota(mount / group.relative_path()));
  return least;
}

bool lists_cpu(const std::string& controllers) { return ("," + controllers + ",").find(",cpu,") != std::string::npos; }

/// Lines of /proc/self/cgroup are "id:controllers:path"; version 2 has no controllers.
double group_quota(const fs::path& root) {
  double least = unlimited;
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    const fs::path mount = root / "sys/fs/cgroup";
    if (controllers.empty()) least = std::min(least, least_quota(mount, group, quota_v2));
    if (lists_cpu(controllers)) least = std::min(least, least_quota(mount / controllers, group, quota_v1));
  }
  return least;
}

}  // namespace

int usable_cores(const fs::path& root) {
  return std::max(1, static_cast<int>(std::min(bound_cores(), std::ceil(group_quota(root)))));
}

std::string bound_to() {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof(set), &set);
  std::string text;
  for (int first = 0; first < CPU_SETSIZE; ++first) {
    if (!CPU_ISSET(first, &set)) continue;
    int last = first;
    while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &set)) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", first);
    if (last > first) text += fmt::format("-{}", last);
    first = last;
  }
  return text;
}

}  // namespace moraine::runtime
