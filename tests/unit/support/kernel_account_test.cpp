// SPDX-License-Identifier: Apache-2.0
#include "support/kernel_account.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <chrono>
#include <cstddef>
#include <thread>

namespace meridian::watch {
namespace {

TEST(KernelAccount, CatchesEveryFirstTouchOfAPage) {
  constexpr std::size_t kPages = 64;
  constexpr std::size_t kPage = 4096;
  void* const map =
      mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(map, MAP_FAILED);
  madvise(map, kPages * kPage, MADV_NOHUGEPAGE);
  auto* const bytes = static_cast<volatile std::byte*>(map);
  const KernelAccount begin = kernel_account();
  for (std::size_t i = 0; i < kPages; ++i) {
    bytes[i * kPage] = std::byte{1};
  }
  const KernelAccount first = kernel_account() - begin;
  const KernelAccount warm = kernel_account();
  for (std::size_t i = 0; i < kPages; ++i) {
    bytes[i * kPage] = std::byte{2};
  }
  const KernelAccount second = kernel_account() - warm;
  munmap(map, kPages * kPage);
  EXPECT_GE(first.minor_faults, static_cast<long>(kPages));
  EXPECT_EQ(second.minor_faults, 0);
  EXPECT_EQ(second.major_faults, 0);
}

TEST(KernelAccount, BooksOneVoluntarySwitchPerSleep) {
  const KernelAccount begin = kernel_account();
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  // A host stall may let a sleep end before it began, or a lock inside the kernel add one.
  EXPECT_NEAR(static_cast<double>((kernel_account() - begin).voluntary_switches), 20, 2);
}

}  // namespace
}  // namespace meridian::watch
