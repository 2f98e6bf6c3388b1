// SPDX-License-Identifier: Apache-2.0
#include "support/watch_report.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace meridian::watch {
namespace {

/// Writes one line into the pipe; false while nobody reads it.
bool try_write_line(const std::filesystem::path& pipe, const std::string& line) {
  const int descriptor = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    return false;
  }
  const std::string text = line + "\n";
  const bool is_written =
      write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(descriptor);
  return is_written;
}

void read_callers(const std::filesystem::path& path, Report& report) {
  std::ifstream file(path);
  pid_t thread_id = 0;
  for (std::string call; file >> thread_id && file.ignore() && std::getline(file, call);) {
    for (ThreadCounts& thread : report) {
      if (thread.thread_id == thread_id) {
        thread.heap_callers.push_back(call);
      }
    }
  }
}

Report read_report(const std::filesystem::path& path) {
  Report report;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);  // names of the columns
  while (std::getline(file, line)) {
    std::istringstream row(line);
    ThreadCounts thread;
    row >> thread.thread_id;
    row.ignore();  // the tab; a name may hold blanks
    std::getline(row, thread.name, '\t');
    row >> thread.allocations >> thread.frees >> thread.locks >> thread.contended_locks >>
        thread.minor_faults >> thread.major_faults >> thread.voluntary_switches >>
        thread.involuntary_switches;
    if (!row.fail()) {
      report.push_back(thread);
    }
  }
  return report;
}

}  // namespace

WatchedProgram::WatchedProgram(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::filesystem::create_directories(folder_);
}

std::vector<std::string> WatchedProgram::environment() const {
  return {"MERIDIAN_WATCH=" + folder_.string(), "LD_PRELOAD=" MERIDIAN_WATCH_LIBRARY};
}

Report WatchedProgram::report(const std::string& label,
                              std::chrono::milliseconds answer_within) const {
  const auto give_up = std::chrono::steady_clock::now() + answer_within;
  const auto answer = folder_ / (label + ".tsv");
  bool is_asked = false;
  while (!std::filesystem::exists(answer)) {
    is_asked = is_asked || try_write_line(folder_ / "marker", label);
    if (std::chrono::steady_clock::now() > give_up) {
      throw std::runtime_error("no report \"" + label + "\" in " + folder_.string() +
                               ": is the program running with libmeridian_watch.so?");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  Report report = read_report(answer);
  read_callers(folder_ / (label + ".calls"), report);
  return report;
}

Report difference(const Report& begin, const Report& end) {
  Report result;
  for (const ThreadCounts& now : end) {
    const auto then = std::find_if(begin.begin(), begin.end(), [&](const ThreadCounts& thread) {
      return thread.thread_id == now.thread_id && thread.name == now.name;
    });
    if (then == begin.end()) {
      continue;
    }
    ThreadCounts change = now;
    change.allocations -= then->allocations;
    change.frees -= then->frees;
    change.locks -= then->locks;
    change.contended_locks -= then->contended_locks;
    change.minor_faults -= then->minor_faults;
    change.major_faults -= then->major_faults;
    change.voluntary_switches -= then->voluntary_switches;
    change.involuntary_switches -= then->involuntary_switches;
    result.push_back(change);
  }
  return result;
}

const ThreadCounts* find_thread(const Report& report, const std::string& name) {
  const auto found = std::find_if(report.begin(), report.end(),
                                  [&](const ThreadCounts& thread) { return thread.name == name; });
  return found == report.end() ? nullptr : &*found;
}

std::string to_text(const Report& report) {
  std::ostringstream text;
  for (const ThreadCounts& thread : report) {
    text << "  " << thread.name << ": allocations " << thread.allocations << ", frees "
         << thread.frees << ", locks " << thread.locks << " (contended " << thread.contended_locks
         << "), page faults " << thread.minor_faults + thread.major_faults
         << ", voluntary switches " << thread.voluntary_switches << ", involuntary "
         << thread.involuntary_switches << "\n";
  }
  return text.str();
}

std::string callers_text(const ThreadCounts& thread) {
  std::string text;
  for (const std::string& call : thread.heap_callers) {
    text += "  " + call + "\n";
  }
  return text;
}

}  // namespace meridian::watch
