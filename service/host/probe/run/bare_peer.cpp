// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/bare_peer.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "service/host/probe/figures.hpp"
#include "service/host/probe/run/drive_side.hpp"
#include "service/host/process/processors.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::probe {
namespace {

using dds::SetpointSample;
using dds::Writer;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Pins the calling thread, whose set may be that of a thread that keeps off this CPU.
void pin_to(int cpu) {
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  CPU_SET(cpu, &wanted);
  sched_setaffinity(0, sizeof wanted, &wanted);
}

struct Wake {
  std::int64_t late_ns = 0;
  std::int64_t written_ns = 0;
  bool is_elsewhere = false;  ///< not on the real-time CPU: no reference for what is there
};

/// `count` periods on the real-time CPU, in a thread of its own; writes where there is a writer.
std::vector<Wake> run(const BarePeerOptions& options, std::size_t count,
                      Writer<SetpointSample>* writer) {
  const std::int64_t period_ns = options.period_ns;
  std::vector<Wake> wakes(count);
  std::thread thread([&] {
    pin_to(options.cpu);
    prctl(PR_SET_TIMERSLACK, 1UL);
    const sched_param parameters{.sched_priority = options.priority};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    SetpointSample sample;
    const std::int64_t start = monotonic_ns();
    std::int64_t n = 0;
    for (std::size_t i = 0; i < count; ++i) {
      n = std::max(n + 1, (monotonic_ns() - start) / period_ns + 1);
      const std::int64_t due_ns = start + n * period_ns;
      const timespec due{.tv_sec = due_ns / kSecond_ns, .tv_nsec = due_ns % kSecond_ns};
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
      }
      wakes[i].late_ns = monotonic_ns() - due_ns;
      wakes[i].is_elsewhere = sched_getcpu() != options.cpu;
      if (writer != nullptr) {
        sample.setpoint.cycle = i;
        sample.setpoint.due_ns = due_ns;
        wakes[i].written_ns = monotonic_ns();
        (void)writer->write(sample);
      }
    }
  });
  thread.join();
  return wakes;
}

/// Processors awake for as long as this process lives.
void hold_dma_latency() {
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t zero_us = 0;
  if (file >= 0 && write(file, &zero_us, sizeof zero_us) < 0) {
    std::fputs("bare peer: processors may sleep deeply\n", stderr);
  }
}

/// When the answer to each ping was here, on Cyclone's receive thread.
class Answers {
 public:
  explicit Answers(dds::Participant& participant)
      : reader_(
            participant,
            [this](dds::Reader<dds::DriveFeedback>& reader) {
              dds::DriveFeedback answer;
              while (reader.take(answer)) {
                const std::int64_t now_ns = monotonic_ns();
                if (answer.cycle_seen < seen_ns_.size()) seen_ns_[answer.cycle_seen] = now_ns;
              }
            },
            kDepth) {}

  void forget() {
    for (auto& seen : seen_ns_) seen = 0;
  }
  [[nodiscard]] std::int64_t seen_ns(std::size_t cycle) const {
    return cycle < seen_ns_.size() ? seen_ns_[cycle].load() : 0;
  }

 private:
  static constexpr int kDepth = 64;
  std::vector<std::atomic<std::int64_t>> seen_ns_ = std::vector<std::atomic<std::int64_t>>(200'000);
  dds::Reader<dds::DriveFeedback> reader_;
};

/// How many of them were elsewhere, with which an answer begins.
std::string elsewhere(const std::vector<Wake>& wakes) {
  return std::to_string(std::count_if(wakes.begin(), wakes.end(),
                                      [](const Wake& one) { return one.is_elsewhere; })) +
         " ";
}

std::string wake(const BarePeerOptions& options, std::size_t count) {
  const auto wakes = run(options, count, nullptr);
  std::string answer = elsewhere(wakes);
  for (const Wake& one : wakes) answer += std::to_string(one.late_ns) + " ";
  return answer;
}

std::string ping(const BarePeerOptions& options, std::size_t count, Writer<SetpointSample>& writer,
                 Answers& answers) {
  answers.forget();
  const auto wakes = run(options, count, &writer);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the last answer is on its way
  std::string answer = elsewhere(wakes);
  for (std::size_t i = 0; i < wakes.size(); ++i) {
    const std::int64_t seen_ns = answers.seen_ns(i);
    answer += std::to_string(i) + ":" + std::to_string(wakes[i].written_ns) + ":" +
              std::to_string(seen_ns > 0 ? seen_ns - wakes[i].written_ns : 0) + " ";
  }
  return answer;
}

}  // namespace

void run_bare_peer(const BarePeerOptions& options) {
  mlockall(MCL_CURRENT | MCL_FUTURE);
  hold_dma_latency();
  process::stay_off_cpu(options.cpu);  // Cyclone's threads inherit this
  dds::Participant participant({.domain = options.domain,
                                .machine = options.partition,
                                .transport = has_realtime_rights()
                                                 ? dds::Transport::kLoopbackRealtime
                                                 : dds::Transport::kLoopback});
  Writer<SetpointSample> writer(participant);
  writer.register_instance({});
  Answers answers(participant);
  std::cout << "ready" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string verb;
    std::size_t count = 0;
    words >> verb >> count;
    std::cout << (verb == "ping" ? ping(options, count, writer, answers) : wake(options, count))
              << std::endl;
  }
}

}  // namespace meridian::probe
