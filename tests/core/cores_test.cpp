// Cores that the system keeps from this program do not count, nor those that its quota cannot keep busy.
#include "core/cores.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

namespace weft {
namespace {

TEST(Cores, AreThoseThatAThreadMayRunOn) {
  const std::uint32_t before = usable_cores();
  EXPECT_GE(before, 1u);
  std::uint32_t in_one = 0;
  std::thread([&] {  // a thread's own affinity: the others keep theirs
    cpu_set_t allowed;
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    int first = 0;
    while (!CPU_ISSET(first, &allowed)) ++first;
    CPU_ZERO(&allowed);
    CPU_SET(first, &allowed);
    ASSERT_EQ(sched_setaffinity(0, sizeof allowed, &allowed), 0);
    in_one = usable_cores();
  })
      .join();
  EXPECT_EQ(in_one, 1u);
  EXPECT_EQ(usable_cores(), before);
}

/// A folder in place of /sys/fs/cgroup, and a file in place of /proc/self/cgroup beside it.
class Quotas : public testing::Test {
 protected:
  ~Quotas() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
  std::optional<std::uint32_t> cores() { return quota_cores(folder_ / "self", folder_ / "fs"); }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("weft-quota-" + std::to_string(getpid()));
};

TEST_F(Quotas, AreTheLeastOfTheGroupAndThoseAboveIt) {
  write("self", "0::/group/job\n");
  EXPECT_EQ(cores(), std::nullopt);  // nothing can be read
  write("fs/group/job/cpu.max", "max 100000\n");
  EXPECT_EQ(cores(), std::nullopt);
  write("fs/group/cpu.max", "250000 100000\n");
  EXPECT_EQ(cores(), 3u);  // rounded up
  write("fs/group/job/cpu.max", "200000 100000\n");
  EXPECT_EQ(cores(), 2u);
  write("fs/cpu.max", "1000 100000\n");  // the root of a container
  EXPECT_EQ(cores(), 1u);
  write("fs/cpu.max", "soon\n");
  EXPECT_EQ(cores(), 2u);
  write("self", "0::/elsewhere\n");
  EXPECT_EQ(cores(), std::nullopt);
  write("self", "0::/../group\n");
  EXPECT_EQ(cores(), 3u);
}

TEST_F(Quotas, OfVersion1StandInTheControllersFolder) {
  write("self", "5:memory:/job\n4:cpu,cpuacct:/host/job\n0::/\n");
  write("fs/memory/job/cpu.max", "100000 100000\n");
  write("fs/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  write("fs/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cores(), std::nullopt);
  write("fs/cpu,cpuacct/cpu.cfs_quota_us", "150000\n");  // the mount is the group itself, as in a container
  EXPECT_EQ(cores(), 2u);
}

}  // namespace
}  // namespace weft
