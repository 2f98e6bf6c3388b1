// SPDX-License-Identifier: Apache-2.0

/// bare_peer CPU DOMAIN PERIOD_NS PARTITION: what the service is compared with. A process with one
/// thread, FIFO 80 and pinned as the service's cycle (where the rights are there), that does
/// nothing but sleep to start + n * period, and on request write a sample of the setpoint's size
/// and quality of service with nothing in between. Commands on standard input, one a line; each is
/// answered by one line:
///
///     wake N   wakes N times: the N latenesses, ns
///     ping N   wakes N times and writes each time: N times "cycle:written_at_ns"
///
/// Warm-up is the caller's to drop.

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "latency/figures.hpp"
#include "service/dds/messages.hpp"
#include "service/dds/writer.hpp"

namespace {

using meridian::dds::SetpointSample;
using meridian::dds::Writer;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

void pin(bool to, int cpu) {
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof allowed, &allowed);
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &allowed) && (i == cpu) == to) {
      CPU_SET(i, &wanted);
    }
  }
  if (CPU_COUNT(&wanted) > 0) {
    sched_setaffinity(0, sizeof wanted, &wanted);
  }
}

struct Wake {
  std::int64_t late_ns = 0;
  std::int64_t written_ns = 0;
};

/// `count` periods on the real-time CPU, in a thread of its own; writes where there is a writer.
std::vector<Wake> run(int cpu, std::int64_t period_ns, std::size_t count,
                      Writer<SetpointSample>* writer) {
  std::vector<Wake> wakes(count);
  std::thread thread([&] {
    pin(true, cpu);
    prctl(PR_SET_TIMERSLACK, 1UL);
    const sched_param parameters{.sched_priority = 80};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    SetpointSample sample;
    const std::int64_t start = now_ns();
    std::int64_t n = 0;
    for (std::size_t i = 0; i < count; ++i) {
      n = std::max(n + 1, (now_ns() - start) / period_ns + 1);
      const std::int64_t due_ns = start + n * period_ns;
      const timespec due{.tv_sec = due_ns / kSecond_ns, .tv_nsec = due_ns % kSecond_ns};
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
      }
      wakes[i].late_ns = now_ns() - due_ns;
      if (writer != nullptr) {
        sample.setpoint.cycle = i;
        sample.setpoint.due_ns = due_ns;
        wakes[i].written_ns = now_ns();
        (void)writer->write(sample);
      }
    }
  });
  thread.join();
  return wakes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fputs("usage: bare_peer CPU DOMAIN PERIOD_NS PARTITION\n", stderr);
    return 2;
  }
  const int cpu = std::atoi(argv[1]);
  const auto domain = static_cast<std::uint32_t>(std::atoi(argv[2]));
  const std::int64_t period_ns = std::atoll(argv[3]);
  mlockall(MCL_CURRENT | MCL_FUTURE);
  const int dma_latency = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t zero_us = 0;
  if (dma_latency >= 0 && write(dma_latency, &zero_us, sizeof zero_us) < 0) {
    std::fputs("bare_peer: processors may sleep deeply\n", stderr);
  }
  pin(false, cpu);  // Cyclone's threads inherit this
  meridian::dds::Participant participant(
      {.domain = domain,
       .machine = argv[4],
       .transport = meridian::latency::has_realtime_rights()
                        ? meridian::dds::Transport::kLoopbackRealtime
                        : meridian::dds::Transport::kLoopback});
  Writer<SetpointSample> writer(participant);
  writer.register_instance({});
  std::cout << "ready" << std::endl;

  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string verb;
    std::size_t count = 0;
    words >> verb >> count;
    const bool is_ping = verb == "ping";
    std::string answer;
    const auto wakes = run(cpu, period_ns, count, is_ping ? &writer : nullptr);
    for (std::size_t i = 0; i < wakes.size(); ++i) {
      answer += is_ping ? std::to_string(i) + ":" + std::to_string(wakes[i].written_ns) + " "
                        : std::to_string(wakes[i].late_ns) + " ";
    }
    std::cout << answer << std::endl;
  }
  return 0;
}
