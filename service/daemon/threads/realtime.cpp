// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/realtime.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace meridian::interpolator {
namespace {

/// Touched by every thread before its work begins.
constexpr std::size_t kPrefault_bytes = 128 * 1024;

[[gnu::noinline]] void prefault_stack() {
  std::array<char, kPrefault_bytes> stack;
  volatile char* bytes = stack.data();
  for (std::size_t i = 0; i < stack.size(); i += 1024) bytes[i] = 0;
}

/// Whether this thread could run at FIFO `priority`; it is as before afterwards.
bool may_run_at(int priority) {
  int old_policy = 0;
  sched_param old_param{};
  pthread_getschedparam(pthread_self(), &old_policy, &old_param);
  const sched_param param{.sched_priority = priority};
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) != 0) return false;
  pthread_setschedparam(pthread_self(), old_policy, &old_param);
  return true;
}

struct Start {
  std::string name;
  std::function<void()> body;
};

void* run(void* argument) {
  const std::unique_ptr<Start> start(static_cast<Start*>(argument));
  pthread_setname_np(pthread_self(), start->name.substr(0, 15).c_str());
  prctl(PR_SET_TIMERSLACK, 1UL);
  prefault_stack();
  start->body();
  return nullptr;
}

}  // namespace

Realtime::Realtime(const config::RealtimeConfig& wish) : wish_(wish) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  cpu_ = wish.cpu;
  for (int cpu = 0; wish.cpu < 0 && cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &allowed)) cpu_ = cpu;
  }
  if (!CPU_ISSET(cpu_, &allowed)) {
    throw StartError("real-time CPU " + std::to_string(cpu_) +
                     " is not one that this process may use; set [realtime] cpu in the service "
                     "file, or -1 for the last one");
  }
  CPU_ZERO(&realtime_cpus_);
  CPU_SET(cpu_, &realtime_cpus_);
  other_cpus_ = allowed;
  if (CPU_COUNT(&allowed) > 1) {
    CPU_CLR(cpu_, &other_cpus_);
  } else {
    remarks_.push_back("there is one CPU only: everything shares it with the cycle");
  }
  pthread_setaffinity_np(pthread_self(), sizeof other_cpus_, &other_cpus_);

  has_priorities_ = may_run_at(wish.cycle_priority);
  need(has_priorities_,
       "no right to run threads at FIFO priority " + std::to_string(wish.cycle_priority),
       "run as root, grant CAP_SYS_NICE or 'LimitRTPRIO=" + std::to_string(wish.cycle_priority) +
           "'; in a cpu cgroup of version 1 give it cpu.rt_runtime_us");
  if (wish.lock_memory) {
    // Freed memory stays with the process: it is locked, and no later call faults.
    mallopt(M_TRIM_THRESHOLD, -1);
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_ARENA_MAX, 2);
    need(mlockall(MCL_CURRENT | MCL_FUTURE) == 0, "memory cannot be locked",
         "run as root, grant CAP_IPC_LOCK or 'LimitMEMLOCK=infinity'");
  }
  if (wish.hold_dma_latency) {
    dma_latency_ = ::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    const std::int32_t zero_us = 0;
    need(dma_latency_ >= 0 && ::write(dma_latency_, &zero_us, sizeof zero_us) == sizeof zero_us,
         "/dev/cpu_dma_latency cannot be held at 0 (processors may sleep deeply)",
         "let the service's user write that device (a udev rule), or set [realtime] "
         "hold_dma_latency = false");
  }
}

void Realtime::rise_to(int priority) const noexcept {
  const sched_param param{.sched_priority = priority};
  if (has_priorities_) (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
}

Realtime::~Realtime() {
  if (dma_latency_ >= 0) ::close(dma_latency_);
}

void Realtime::need(bool is_there, const std::string& what, const std::string& remedy) {
  if (is_there) return;
  if (is_enforced()) {
    throw StartError("real time is enforced, but " + what + "; remedy: " + remedy +
                     ", or set mode = \"best_effort\" under [realtime] in the service file");
  }
  remarks_.push_back("best effort: " + what + "; remedy: " + remedy);
}

Thread::Thread(const Realtime& realtime, const ThreadPlan& plan, std::function<void()> body) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStack_bytes);
  const cpu_set_t& cpus = plan.is_on_realtime_cpu ? realtime.realtime_cpus_ : realtime.other_cpus_;
  pthread_attr_setaffinity_np(&attributes, sizeof cpus, &cpus);
  if (plan.priority > 0 && realtime.has_priorities()) {
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    const sched_param param{.sched_priority = plan.priority};
    pthread_attr_setschedparam(&attributes, &param);
  }
  auto start = std::make_unique<Start>(Start{plan.name, std::move(body)});
  const int failed = pthread_create(&thread_, &attributes, &run, start.get());
  pthread_attr_destroy(&attributes);
  if (failed != 0) {
    throw StartError("thread '" + plan.name + "' cannot be started: " + std::strerror(failed));
  }
  (void)start.release();
  is_running_ = true;
}

Thread::Thread(Thread&& other) noexcept
    : thread_(other.thread_), is_running_(std::exchange(other.is_running_, false)) {}

Thread& Thread::operator=(Thread&& other) noexcept {
  join();
  thread_ = other.thread_;
  is_running_ = std::exchange(other.is_running_, false);
  return *this;
}

void Thread::join() noexcept {
  if (is_running_) pthread_join(thread_, nullptr);
  is_running_ = false;
}

}  // namespace meridian::interpolator
