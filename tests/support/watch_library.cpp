// SPDX-License-Identifier: Apache-2.0

/// libmeridian_watch.so: counters of every thread of a program that was not built for it.
///
///     MERIDIAN_WATCH=FOLDER LD_PRELOAD=libmeridian_watch.so meridiand ...
///
/// The program gets one more thread, `watch`, that reads labels from the pipe FOLDER/marker, one a
/// line, and answers each by the file FOLDER/LABEL.tsv: one row per thread of that moment (columns:
/// see kColumns), and FOLDER/LABEL.calls: who made the first heap calls of each thread since the
/// report before (thread id, tab, callers; see call_trace.hpp). The difference of two such files is
/// what each thread did in between; nothing is measured on the watched threads but the counting
/// itself. watch_report.hpp is the other end.

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#include "support/call_trace.hpp"
#include "support/watch_slot.hpp"

namespace {

constexpr char kColumns[] =
    "thread_id\tname\tallocations\tfrees\tlocks\tcontended_locks\tminor_faults\tmajor_faults\t"
    "voluntary_switches\tinvoluntary_switches\n";

struct Booked {
  unsigned long minor_faults = 0, major_faults = 0, voluntary = 0, involuntary = 0;
  char name[32] = "";
};

/// Reads what the kernel booked to a thread; false where the thread has ended meanwhile.
bool read_account(pid_t thread, Booked& booked) {
  char path[64];
  std::snprintf(path, sizeof path, "/proc/self/task/%d/stat", thread);
  std::FILE* file = std::fopen(path, "r");
  if (file == nullptr) {
    return false;
  }
  char line[1024];
  const bool is_read = std::fgets(line, sizeof line, file) != nullptr;
  std::fclose(file);
  const char* const open = is_read ? std::strchr(line, '(') : nullptr;
  const char* const close = is_read ? std::strrchr(line, ')') : nullptr;
  if (open == nullptr || close == nullptr) {
    return false;
  }
  std::snprintf(booked.name, sizeof booked.name, "%.*s", static_cast<int>(close - open - 1),
                open + 1);
  // After the name: state ppid pgrp session tty tpgid flags minflt cminflt majflt (proc(5)).
  std::sscanf(close + 1, " %*c %*d %*d %*d %*d %*d %*u %lu %*u %lu", &booked.minor_faults,
              &booked.major_faults);

  std::snprintf(path, sizeof path, "/proc/self/task/%d/status", thread);
  file = std::fopen(path, "r");
  if (file == nullptr) {
    return false;
  }
  while (std::fgets(line, sizeof line, file) != nullptr) {
    std::sscanf(line, "voluntary_ctxt_switches: %lu", &booked.voluntary);
    std::sscanf(line, "nonvoluntary_ctxt_switches: %lu", &booked.involuntary);
  }
  std::fclose(file);
  return true;
}

void write_row(std::FILE* out, pid_t thread) {
  Booked booked;
  if (!read_account(thread, booked)) {
    return;
  }
  static const meridian::watch::Slot kNothing;
  const meridian::watch::Slot* slot = meridian::watch::find_slot(thread);
  if (slot == nullptr) {
    slot = &kNothing;
  }
  std::fprintf(out, "%d\t%s\t%lu\t%lu\t%lu\t%lu\t%lu\t%lu\t%lu\t%lu\n", thread, booked.name,
               slot->allocations.load(), slot->frees.load(), slot->locks.load(),
               slot->contended_locks.load(), booked.minor_faults, booked.major_faults,
               booked.voluntary, booked.involuntary);
}

/// Prints the heap calls that were kept for a thread and makes room for the next.
void write_calls(std::FILE* out, pid_t thread) {
  meridian::watch::Slot* const slot = meridian::watch::find_slot(thread);
  if (slot == nullptr) {
    return;
  }
  std::istringstream calls(meridian::watch::traces_text(*slot));
  meridian::watch::keep_traces(*slot);
  for (std::string call; std::getline(calls, call);) {
    std::fprintf(out, "%d\t%s\n", thread, call.c_str());
  }
}

template <class Row>
void for_each_thread(const Row& row) {
  DIR* const tasks = opendir("/proc/self/task");
  if (tasks == nullptr) {
    return;
  }
  while (const dirent* const entry = readdir(tasks)) {
    if (const pid_t thread = std::atoi(entry->d_name); thread > 0) {
      row(thread);
    }
  }
  closedir(tasks);
}

/// Writes FOLDER/LABEL.tsv whole and last: a reader never sees half of it.
void write_report(const char* folder, const char* label) {
  const std::string path = std::string(folder) + "/" + label;
  if (std::FILE* const calls = std::fopen((path + ".calls").c_str(), "w"); calls != nullptr) {
    for_each_thread([calls](pid_t thread) { write_calls(calls, thread); });
    std::fclose(calls);
  }
  std::FILE* const out = std::fopen((path + ".part").c_str(), "w");
  if (out == nullptr) {
    return;
  }
  std::fputs(kColumns, out);
  for_each_thread([out](pid_t thread) { write_row(out, thread); });
  std::fclose(out);
  std::rename((path + ".part").c_str(), (path + ".tsv").c_str());
}

void* serve_markers(void* folder_argument) {
  const char* const folder = static_cast<const char*>(folder_argument);
  pthread_setname_np(pthread_self(), "watch");
  char path[4200];
  std::snprintf(path, sizeof path, "%s/marker", folder);
  // Open for both, so that the pipe stays when a writer leaves.
  const int pipe = open(path, O_RDWR | O_CLOEXEC);
  std::FILE* const labels = pipe < 0 ? nullptr : fdopen(pipe, "r");
  char label[64];
  while (labels != nullptr && std::fgets(label, sizeof label, labels) != nullptr) {
    label[std::strcspn(label, "\n")] = '\0';
    write_report(folder, label);
  }
  return nullptr;
}

__attribute__((constructor)) void start_watch() {
  const char* const folder = std::getenv("MERIDIAN_WATCH");
  if (folder == nullptr) {
    return;
  }
  char path[4200];
  std::snprintf(path, sizeof path, "%s/marker", folder);
  mkfifo(path, 0600);
  static char folder_copy[4096];
  std::snprintf(folder_copy, sizeof folder_copy, "%s", folder);
  unsetenv("MERIDIAN_WATCH");  // children are not watched
  unsetenv("LD_PRELOAD");
  pthread_t thread{};
  if (pthread_create(&thread, nullptr, serve_markers, folder_copy) == 0) {
    pthread_detach(thread);
  }
}

}  // namespace
