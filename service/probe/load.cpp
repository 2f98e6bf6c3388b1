// SPDX-License-Identifier: Apache-2.0
#include "service/probe/load.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>

namespace meridian::probe {
namespace {

void work_on(int cpu, const std::atomic<bool>& is_stopping) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  constexpr std::size_t kBytes = std::size_t{16} * 1024 * 1024;
  std::vector<char> from(kBytes, 1), to(kBytes);
  while (!is_stopping.load(std::memory_order_relaxed)) {
    std::copy(from.begin(), from.end(), to.begin());
    if (std::FILE* const file = std::tmpfile(); file != nullptr) {
      std::fwrite(to.data(), 1, kBytes / 64, file);
      std::fclose(file);
    }
  }
}

}  // namespace

Load::Load() {
  // The thread that makes a probe is kept off the real-time CPU; its load is not.
  const auto cpus = static_cast<int>(std::thread::hardware_concurrency());
  for (int cpu = 0; cpu < cpus; ++cpu) {
    threads_.emplace_back([cpu, this] { work_on(cpu, is_stopping_); });
  }
}

Load::~Load() {
  is_stopping_ = true;
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace meridian::probe
