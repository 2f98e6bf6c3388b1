// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/account.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <latch>
#include <thread>

namespace meridian::process {
namespace {

[[nodiscard]] ThreadAccount thread_called(const std::string& name) {
  const std::vector<ThreadAccount> all = threads_of(getpid());
  const auto at = std::find_if(all.begin(), all.end(),
                               [&name](const ThreadAccount& one) { return one.name == name; });
  return at == all.end() ? ThreadAccount{} : *at;
}

TEST(Account, HoldsAThreadsNameProcessorsClassSwitchesAndFaults) {
  std::latch is_named(1), is_over(1);
  std::thread worker([&] {
    pthread_setname_np(pthread_self(), "a (worker) 7");
    is_named.count_down();
    is_over.wait();
  });
  is_named.wait();
  const ThreadAccount before = thread_called("a (worker) 7");
  EXPECT_GT(before.id, 0);
  EXPECT_FALSE(before.processors.empty());
  EXPECT_EQ(scheduling_text(before), sched_getscheduler(0) == SCHED_IDLE ? "idle" : "normal");
  is_over.count_down();
  worker.join();
  // Whoever joins is woken before the kernel has taken the thread off its list.
  for (int n = 0; n < 5000 && thread_called("a (worker) 7").id != 0; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(thread_called("a (worker) 7").id, 0) << "it is gone";

  const auto main_thread = [] {
    const auto all = threads_of(getpid());
    return *std::find_if(all.begin(), all.end(),
                         [](const ThreadAccount& one) { return one.id == getpid(); });
  };
  const ThreadAccount first = main_thread();
  constexpr std::size_t kPages = 64;
  const auto size = kPages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  void* const fresh =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(fresh, MAP_FAILED);
  madvise(fresh, size, MADV_NOHUGEPAGE);
  for (std::size_t i = 0; i < kPages; ++i)
    static_cast<volatile char*>(fresh)[i * size / kPages] = 1;
  for (int i = 0; i < 5; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const ThreadAccount last = main_thread();
  munmap(fresh, size);
  EXPECT_GE(last.minor_faults, first.minor_faults + kPages);
  EXPECT_GE(last.voluntary_switches, first.voluntary_switches + 5);
}

TEST(Account, HoldsWhatIsLocked) {
  const auto before = account_of(getpid());
  ASSERT_TRUE(before);
  constexpr std::size_t kPage = 4096;
  alignas(kPage) static char page[kPage];
  // Sanitizers take mlock() away.
  if (syscall(SYS_mlock, page, kPage) != 0) GTEST_SKIP() << "no right to lock memory";
  EXPECT_GT(account_of(getpid())->locked_mib, before->locked_mib);
  syscall(SYS_munlock, page, kPage);
}

TEST(Account, NamesTheClassOfAThread) {
  EXPECT_EQ(scheduling_text({.policy = SCHED_FIFO, .priority = 80}), "FIFO 80");
  EXPECT_EQ(scheduling_text({.policy = SCHED_RR, .priority = 5}), "RR 5");
  EXPECT_EQ(scheduling_text({.policy = SCHED_IDLE}), "idle");
  EXPECT_EQ(scheduling_text({.policy = SCHED_BATCH}), "class 3");
  EXPECT_TRUE(threads_of(-1).empty());
}

}  // namespace
}  // namespace meridian::process
