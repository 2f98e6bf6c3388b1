// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/load.hpp"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

#include "service/host/process/processors.hpp"
#include "service/host/process/programs.hpp"

namespace meridian::probe {

Load::Load() {
  constexpr std::chrono::seconds kWithin{10};
  const std::string tool = process::program_beside("meridian").string();
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &process::initial_cpus())) continue;
    burners_.push_back(std::make_unique<process::ChildProcess>(
        std::vector<std::string>{tool, "probe", "--burn", std::to_string(cpu)},
        process::ChildProcess::Options{.has_own_group = true}));
  }
  for (const auto& burner : burners_) {
    if (burner->read_line(kWithin) != "burning") {
      throw std::runtime_error("a process of the load does not start");
    }
  }
}

void burn(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  sched_setaffinity(0, sizeof set, &set);
  constexpr std::size_t kBytes = std::size_t{16} * 1024 * 1024;
  std::vector<char> from(kBytes, 1), to(kBytes);
  std::cout << "burning" << std::endl;
  for (;;) {
    std::copy(from.begin(), from.end(), to.begin());
    if (std::FILE* const file = std::tmpfile(); file != nullptr) {
      std::fwrite(to.data(), 1, kBytes / 64, file);
      std::fclose(file);
    }
  }
}

}  // namespace meridian::probe
