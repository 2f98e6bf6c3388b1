// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/load.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>

#include <cerrno>
#include <vector>

#include "service/host/process/processors.hpp"

namespace meridian::probe {
namespace {

TEST(Load, BurnsInProcessesOfItsOwnOnEveryProcessorAndOnlyWhileItLives) {
  std::vector<pid_t> burners;
  {
    const Load load;
    ASSERT_EQ(load.count(), static_cast<std::size_t>(CPU_COUNT(&process::initial_cpus())));
    cpu_set_t covered;
    CPU_ZERO(&covered);
    for (std::size_t i = 0; i < load.count(); ++i) {
      cpu_set_t pinned;
      ASSERT_EQ(sched_getaffinity(load.id(i), sizeof pinned, &pinned), 0);
      EXPECT_EQ(CPU_COUNT(&pinned), 1);
      CPU_OR(&covered, &covered, &pinned);
      burners.push_back(load.id(i));
    }
    EXPECT_TRUE(CPU_EQUAL(&covered, &process::initial_cpus()));
  }
  for (const pid_t burner : burners) {
    EXPECT_EQ(kill(burner, 0), -1);
    EXPECT_EQ(errno, ESRCH);
  }
}

}  // namespace
}  // namespace meridian::probe
