// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "runtime/cores.hpp"

namespace moraine::runtime {
namespace {

namespace fs = std::filesystem;

/// A root of a file system with control groups only.
class Cores : public testing::Test {
 protected:
  Cores() : root_(fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(root_);
  }
  ~Cores() override { fs::remove_all(root_); }

  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << '\n';
  }

  fs::path root_;
};

TEST_F(Cores, AtLeastOneHere) { EXPECT_GE(usable_cores(), 1); }

TEST_F(Cores, WithoutGroupsThoseItIsBoundTo) { EXPECT_GE(usable_cores(root_), usable_cores()); }

TEST_F(Cores, UnlimitedGroupsDoNotLimit) {
  const int bound = usable_cores(root_);
  write("proc/self/cgroup", "0::/a");
  write("sys/fs/cgroup/a/cpu.max", "max 100000");
  EXPECT_EQ(usable_cores(root_), bound);
}

TEST_F(Cores, PartOfACoreCountsAsOne) {
  const int bound = usable_cores(root_);
  write("proc/self/cgroup", "0::/a");
  write("sys/fs/cgroup/a/cpu.max", "110000 100000");
  EXPECT_EQ(usable_cores(root_), std::min(bound, 2));
}

TEST_F(Cores, QuotaOfAnOuterGroupCounts) {
  write("proc/self/cgroup", "0::/a/b");
  write("sys/fs/cgroup/a/cpu.max", "50000 100000");
  write("sys/fs/cgroup/a/b/cpu.max", "900000 100000");
  EXPECT_EQ(usable_cores(root_), 1);
}

TEST_F(Cores, QuotaOfAContainerCounts) {
  write("proc/self/cgroup", "0::/unknown/inside");
  write("sys/fs/cgroup/cpu.max", "20000 100000");
  EXPECT_EQ(usable_cores(root_), 1);
}

TEST_F(Cores, FirstVersionOfGroupsCounts) {
  const int bound = usable_cores(root_);
  write("proc/self/cgroup", "4:cpu,cpuacct:/job\n3:cpuset:/job\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "100000");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "-1");
  EXPECT_EQ(usable_cores(root_), bound);
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "80000");
  EXPECT_EQ(usable_cores(root_), 1);
}

}  // namespace
}  // namespace moraine::runtime
