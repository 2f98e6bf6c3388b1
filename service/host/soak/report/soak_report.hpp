// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "meridian/cycle/histogram.hpp"
#include "service/host/process/account.hpp"
#include "service/host/soak/chaos.hpp"
#include "service/host/soak/report/run_budgets.hpp"
#include "service/host/soak/watch/time_slices.hpp"
#include "service/recording/record/check/check_report.hpp"

namespace meridian::soak {

/// Something that must not be, for the report.
struct Violation {
  std::string text;   ///< a sentence
  std::string where;  ///< segment and program
};

/// How a service stood at one time.
struct Health {
  process::Account process;
  std::vector<process::ThreadAccount> threads;
  std::uint64_t cycles_run = 0;  ///< by its own account
};
/// The one of that name; nullptr where there is none.
[[nodiscard]] const process::ThreadAccount* thread_of(
    const std::vector<process::ThreadAccount>& threads, const std::string& name);
/// Page faults that a thread had between two accounts.
[[nodiscard]] std::uint64_t faults_of(const std::vector<process::ThreadAccount>& first,
                                      const std::vector<process::ThreadAccount>& last,
                                      const std::string& name);

/// One life of the service: from its start to its end or death.
struct Life {
  Health first, last;                         ///< first: when it had warmed up
  std::vector<process::ThreadAccount> ready;  ///< its threads when the machine was Ready first
  double max_resident_mib = 0;
  bool has_first = false;
};

/// A histogram over the whole soak, with the part of it that came first and the one that came last.
struct Drift {
  Histogram all, first, last;
};

/// What a life of the service may use, and may have more of at its end than when it had warmed up.
struct GrowthBudgets {
  double resident_mib = 0;
  double more_mib = 0, more_files = 0, more_threads = 0;
};
/// From the table of budgets, of a service that `is_traced` or not; throws as probe::load_budget().
[[nodiscard]] GrowthBudgets load_growth_budgets(bool is_traced = false);

/// All that a soak found out, and its verdict. Times s.
struct SoakReport {
  std::string machine, host;
  std::string service_file;  ///< whose real time ran; empty: the default, best effort
  bool is_enforced = false;  ///< as the service says
  int cpu = 0;               ///< of the cycle
  std::string traces;        ///< of slow cycles: where, and which lie there; empty: none asked for
  std::uint64_t seed = 0;
  double asked_s = 0, elapsed_s = 0;
  bool is_over = false;         ///< false: written on the way
  bool is_interrupted = false;  ///< it was asked to end before its time
  std::uint64_t programs = 0, finished = 0, aborted = 0, refused = 0;
  std::uint64_t segments = 0, segments_unread = 0, rows = 0, missing = 0, longest_gap = 0;
  std::array<std::uint64_t, kMishapCount> mishaps{};    ///< that came to pass
  std::uint64_t asks_refused = 0, asks_unanswered = 0;  ///< what the operator wanted in vain
  std::uint64_t alarms = 0, service_starts = 0, drive_starts = 0;
  std::uint64_t host_faults = 0;  ///< the host kept service or drives from their processors
  bool is_host_watched = false;   ///< else what follows says nothing
  std::uint64_t host_stalls = 0;  ///< so often it took one away for 10 ms or more
  double host_longest_s = 0;
  std::int64_t host_nap_ns = 5'000'000;             ///< of who watched it
  double tip_mm = 0, axis_rad = 0;                  ///< largest deviations
  double velocity = 0, acceleration = 0, jerk = 0;  ///< largest share of a limit
  std::uint64_t cycles_run = 0, periods_lost = 0, overruns = 0, starvations = 0;
  std::uint64_t periods_lost_to_host = 0;  ///< of periods_lost: HostCredit
  std::uint64_t overruns_by_host = 0;      ///< of overruns: OverrunExcuse
  std::vector<Life> lives;
  /// Latencies, lateness of a bare thread on the cycle's processor, and kCutting.
  TimeSlices slices;
  std::map<std::string, Drift> latencies;
  std::vector<Violation> violations;  ///< the first kMaxViolations
  std::uint64_t violation_count = 0;
  GrowthBudgets allowed = load_growth_budgets();
  RunBudgets budgets = load_run_budgets();
  static constexpr std::size_t kMaxViolations = 100;

  void violate(std::string text, std::string where);
  /// Takes the result of one segment.
  void add(const record::CheckReport& check, const std::string& where);
  /// Nothing was violated by the machine until now, and its host let it run.
  [[nodiscard]] bool is_clean() const { return is_clean(check_run(*this)); }
  /// The same, by what check_run() said of it.
  [[nodiscard]] bool is_clean(const std::vector<CheckResult>& results) const;
  /// The same of a soak that was not interrupted.
  [[nodiscard]] bool passed() const { return is_clean() && !is_interrupted; }
};

/// What speaks against the service's memory, files and threads; empty where nothing does. The first
/// ten seconds of a life are warm-up.
[[nodiscard]] std::vector<std::string> growth(const SoakReport& report);

[[nodiscard]] std::string to_text(const SoakReport& report);
[[nodiscard]] std::string to_json(const SoakReport& report);

}  // namespace meridian::soak
