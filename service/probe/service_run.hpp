// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meridian/rt/histogram.hpp"
#include "service/dds/messages.hpp"
#include "service/dds/reader.hpp"
#include "service/probe/drive_side.hpp"
#include "service/process/child_process.hpp"

namespace meridian::probe {

/// What the recording of record says about the time of one cycle.
struct CycleTimes {
  std::int64_t due_ns = 0, woke_ns = 0;
  std::uint64_t lost = 0;            ///< periods before it that nobody executed
  std::int64_t lateness_ns = 0;      ///< actual wake-up minus when the first of these was due
  std::int64_t computation_ns = -1;  ///< told by the row of the next cycle; -1: there is none
  bool is_moving = false;            ///< a program, or the approach to it, was on its way
};

/// Reads the times of every row of `recording`, by cycle, of a machine with cycles of `period_ns`.
[[nodiscard]] std::map<std::uint64_t, CycleTimes> read_times(const std::filesystem::path& recording,
                                                             std::int64_t period_ns);

/// The real service in Off, running only while it has its turn, with this process as its drives.
/// meridiand lies beside the running program.
class ServiceRun {
 public:
  /// Starts it in `folder`, which gets its recording and its log. `machine` is its file, `name` the
  /// name of that machine; `turns` how many there will be at most.
  ServiceRun(std::uint32_t domain, std::filesystem::path folder, const std::string& machine,
             const std::string& name, std::int64_t period_ns, int turns);

  /// Whether setpoints arrive within 10 s of its start.
  [[nodiscard]] bool is_up() const;
  void take_turn();
  void pause();

  /// What the turns were.
  struct Result {
    std::vector<std::vector<std::int64_t>> lateness_ns, one_way_ns;  ///< by turn
    std::optional<Histogram> round_trip;  ///< setpoint sent until the drives' answer is here
    std::size_t sent = 0;                 ///< setpoints in the turns
    std::size_t untimed = 0;  ///< before a lost period: when they were computed is not told
    std::size_t unseen = 0;   ///< never came to the drives
    std::uint64_t lost_periods = 0;
  };
  /// Ends the service; throws std::runtime_error where it does not end as it should.
  [[nodiscard]] Result end();

 private:
  struct Window {
    std::int64_t begin_ns = 0, end_ns = 0;
    [[nodiscard]] bool contains(std::int64_t time_ns) const {
      return time_ns >= begin_ns && time_ns < end_ns;
    }
  };
  static void add_turn(const Window& window, const std::map<std::uint64_t, CycleTimes>& times,
                       const std::vector<DriveSide::Arrival>& arrivals, Result& result);

  std::filesystem::path recording_;
  std::int64_t period_ns_;
  DriveSide drive_side_;
  dds::Reader<dds::Latency> latencies_;
  process::ChildProcess process_;
  std::vector<Window> windows_;
};

}  // namespace meridian::probe
