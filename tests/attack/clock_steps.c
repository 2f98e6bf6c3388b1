// SPDX-License-Identifier: Apache-2.0
// Preloaded into a process: its clock of the day is an hour ahead or behind, in turns of 0.7 s, and
// waits for a time of that clock end when it shows that time, as where the host's clock is stepped.
// The monotonic clock is left alone. No right to set the clock is needed.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { kHour_s = 3600, kTurn_ms = 700 };
static const long kSecond_ns = 1000000000L, kMillisecond_ns = 1000000L;
static const time_t kFirstDay_s = 1000000000;  // what is less is a monotonic time

static long uptime_ms(void) {
  struct timespec now;
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1000 + now.tv_nsec / kMillisecond_ns;
}

static long step_s(void) { return uptime_ms() / kTurn_ms % 2 == 0 ? kHour_s : -kHour_s; }

int clock_gettime(clockid_t id, struct timespec* now) {
  const long result = syscall(SYS_clock_gettime, id, now);
  if (result == 0 && (id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE)) now->tv_sec += step_s();
  return (int)result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  struct timespec precise;
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* now) {
  struct timespec precise;
  clock_gettime(CLOCK_REALTIME, &precise);
  if (now != NULL) *now = precise.tv_sec;
  return precise.tv_sec;
}

// Until this clock shows `deadline`: to the next step at the longest, then it is looked at again.
int pthread_cond_timedwait(pthread_cond_t* restrict condition, pthread_mutex_t* restrict mutex,
                           const struct timespec* restrict deadline) {
  static int (*wait_until)(pthread_cond_t*, pthread_mutex_t*, const struct timespec*);
  if (wait_until == NULL) {
    *(void**)&wait_until = dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
  }
  if (deadline->tv_sec < kFirstDay_s) return wait_until(condition, mutex, deadline);
  for (;;) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    long left_ns = kSecond_ns * 10;
    if (deadline->tv_sec - now.tv_sec < 10) {
      left_ns = (deadline->tv_sec - now.tv_sec) * kSecond_ns + deadline->tv_nsec - now.tv_nsec;
    }
    if (left_ns <= 0) return ETIMEDOUT;
    const long turn_ns = (kTurn_ms - uptime_ms() % kTurn_ms) * kMillisecond_ns;
    if (turn_ns < left_ns) left_ns = turn_ns;
    struct timespec until;
    syscall(SYS_clock_gettime, CLOCK_REALTIME, &until);
    until.tv_nsec += left_ns % kSecond_ns;
    until.tv_sec += left_ns / kSecond_ns + until.tv_nsec / kSecond_ns;
    until.tv_nsec %= kSecond_ns;
    const int result = wait_until(condition, mutex, &until);
    if (result != ETIMEDOUT) return result;
  }
}
