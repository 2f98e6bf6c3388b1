// SPDX-License-Identifier: Apache-2.0
#include "support/lock_watch.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>

#include "support/watch_slot.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MERIDIAN_LOCK_WATCHED 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MERIDIAN_LOCK_WATCHED 0
#endif
#endif
#ifndef MERIDIAN_LOCK_WATCHED
#define MERIDIAN_LOCK_WATCHED 1
#endif

namespace meridian::watch {

bool is_lock_watched() noexcept { return MERIDIAN_LOCK_WATCHED != 0; }

LockCalls lock_calls() noexcept {
  const Slot& slot = slot_of_this_thread();
  return {slot.locks.load(std::memory_order_relaxed),
          slot.contended_locks.load(std::memory_order_relaxed)};
}

}  // namespace meridian::watch

#if MERIDIAN_LOCK_WATCHED

namespace {

using meridian::watch::count;
using meridian::watch::slot_of_this_thread;

/// The C library's function of that name and version, looked up once. Condition variables have an
/// older version whose objects are laid out otherwise, so the version is always said.
template <class Function>
class Real {
 public:
  constexpr Real(const char* name, const char* version) noexcept : name_(name), version_(version) {}

  Function* get() noexcept {
    Function* found = found_.load(std::memory_order_acquire);
    if (found == nullptr) {
      found = reinterpret_cast<Function*>(dlvsym(RTLD_NEXT, name_, version_));
      found_.store(found, std::memory_order_release);
    }
    return found;
  }

 private:
  const char* name_;
  const char* version_;
  std::atomic<Function*> found_{nullptr};
};

using MutexFunction = int(pthread_mutex_t*);
using RwlockFunction = int(pthread_rwlock_t*);

using ConditionWait = int(pthread_cond_t*, pthread_mutex_t*);
using ConditionTimedWait = int(pthread_cond_t*, pthread_mutex_t*, const timespec*);
using ConditionClockWait = int(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);

constinit Real<MutexFunction> real_mutex_lock{"pthread_mutex_lock", "GLIBC_2.2.5"};
constinit Real<MutexFunction> real_mutex_trylock{"pthread_mutex_trylock", "GLIBC_2.34"};
constinit Real<RwlockFunction> real_rdlock{"pthread_rwlock_rdlock", "GLIBC_2.34"};
constinit Real<RwlockFunction> real_tryrdlock{"pthread_rwlock_tryrdlock", "GLIBC_2.34"};
constinit Real<RwlockFunction> real_wrlock{"pthread_rwlock_wrlock", "GLIBC_2.34"};
constinit Real<RwlockFunction> real_trywrlock{"pthread_rwlock_trywrlock", "GLIBC_2.34"};
constinit Real<ConditionWait> real_wait{"pthread_cond_wait", "GLIBC_2.3.2"};
constinit Real<ConditionTimedWait> real_timedwait{"pthread_cond_timedwait", "GLIBC_2.3.2"};
constinit Real<ConditionClockWait> real_clockwait{"pthread_cond_clockwait", "GLIBC_2.34"};

/// At load: a name that is first looked up in a watched thread, at its first contended lock, would
/// count as that thread's heap calls.
[[gnu::constructor]] void look_names_up() noexcept {
  for (auto* real : {&real_mutex_lock, &real_mutex_trylock}) (void)real->get();
  for (auto* real : {&real_rdlock, &real_tryrdlock, &real_wrlock, &real_trywrlock})
    (void)real->get();
  (void)real_wait.get();
  (void)real_timedwait.get();
  (void)real_clockwait.get();
}

/// Counts, tries, and waits only where the try fails, which is what contended means.
template <class Function, class Lock>
int lock_counted(Real<Function>& real_try, Real<Function>& real_lock, Lock* lock) noexcept {
  auto& slot = slot_of_this_thread();
  count(slot.locks);
  const int tried = real_try.get()(lock);
  if (tried != EBUSY) {
    return tried;
  }
  count(slot.contended_locks);
  return real_lock.get()(lock);
}

template <class Function, class Lock>
int try_counted(Real<Function>& real_try, Lock* lock) noexcept {
  auto& slot = slot_of_this_thread();
  count(slot.locks);
  const int tried = real_try.get()(lock);
  if (tried == EBUSY) {
    count(slot.contended_locks);
  }
  return tried;
}

void count_wait() noexcept {
  auto& slot = slot_of_this_thread();
  count(slot.locks);
  count(slot.contended_locks);
}

}  // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  return lock_counted(real_mutex_trylock, real_mutex_lock, mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  return try_counted(real_mutex_trylock, mutex);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  return lock_counted(real_tryrdlock, real_rdlock, lock);
}

int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
  return try_counted(real_tryrdlock, lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  return lock_counted(real_trywrlock, real_wrlock, lock);
}

int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
  return try_counted(real_trywrlock, lock);
}

int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  count_wait();
  return real_wait.get()(condition, mutex);
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const timespec* until) {
  count_wait();
  return real_timedwait.get()(condition, mutex, until);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* until) {
  count_wait();
  return real_clockwait.get()(condition, mutex, clock, until);
}

}  // extern "C"

#endif  // MERIDIAN_LOCK_WATCHED
