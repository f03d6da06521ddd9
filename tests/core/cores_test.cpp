// Cores that the system keeps from this program do not count.
#include "core/cores.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdint>
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

}  // namespace
}  // namespace weft
