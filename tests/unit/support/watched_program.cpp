// SPDX-License-Identifier: Apache-2.0

/// A program with one thread that allocates, locks and faults a known number of times whenever a
/// line arrives on standard input, and one that does nothing: what watch_report_test.cpp watches.

#include <pthread.h>
#include <sys/mman.h>

#include <cstdio>
#include <latch>
#include <mutex>
#include <semaphore>
#include <thread>

int main() {
  std::counting_semaphore<8> go(0);
  std::counting_semaphore<8> done(0);
  std::latch named(2);  // a report names its threads
  std::mutex mutex;
  std::thread busy([&] {
    pthread_setname_np(pthread_self(), "busy");
    named.count_down();
    for (;;) {
      go.acquire();
      for (int i = 0; i < 5; ++i) {
        int* const block = new int(i);
        asm volatile("" : : "r"(block) : "memory");
        delete block;
      }
      for (int i = 0; i < 3; ++i) {
        const std::lock_guard lock(mutex);
      }
      void* const page =
          mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      *static_cast<volatile char*>(page) = 1;
      munmap(page, 4096);
      done.release();
    }
  });
  std::thread idle([&named] {
    pthread_setname_np(pthread_self(), "idle");
    named.count_down();
    std::binary_semaphore(0).acquire();
  });
  named.wait();
  std::puts("ready");
  std::fflush(stdout);
  char line[8];
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    go.release();
    done.acquire();
    std::puts("done");
    std::fflush(stdout);
  }
  std::_Exit(0);
}
