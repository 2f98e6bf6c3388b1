// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// The reading end of libmeridian_watch.so (watch_library.cpp): what each thread of a watched
/// program did.
namespace meridian::watch {

/// Counters of one thread, since it began or between two reports.
struct ThreadCounts {
  pid_t thread_id = 0;
  std::string name;
  std::uint64_t allocations = 0, frees = 0;
  std::uint64_t locks = 0, contended_locks = 0;
  std::uint64_t minor_faults = 0, major_faults = 0;
  std::uint64_t voluntary_switches = 0, involuntary_switches = 0;
  /// Who made the first heap calls since the report before: function < caller < its caller ...
  std::vector<std::string> heap_callers{};
};
using Report = std::vector<ThreadCounts>;

/// A folder in which one watched program answers.
class WatchedProgram {
 public:
  /// Takes an empty folder; give the program environment() when it is started.
  explicit WatchedProgram(std::filesystem::path folder);

  /// NAME=VALUE pairs for the program's environment.
  [[nodiscard]] std::vector<std::string> environment() const;

  /// Asks for a report and waits for it; throws std::runtime_error where no answer comes in time.
  [[nodiscard]] Report report(const std::string& label, std::chrono::milliseconds answer_within =
                                                            std::chrono::seconds(5)) const;

 private:
  std::filesystem::path folder_;
};

/// What threads alive at both reports did in between.
[[nodiscard]] Report difference(const Report& begin, const Report& end);

/// The thread of that name, or null.
[[nodiscard]] const ThreadCounts* find_thread(const Report& report, const std::string& name);

/// One line per thread, for a test's output; heap callers are not in it.
[[nodiscard]] std::string to_text(const Report& report);

/// The heap callers of a thread, one a line.
[[nodiscard]] std::string callers_text(const ThreadCounts& thread);

}  // namespace meridian::watch
