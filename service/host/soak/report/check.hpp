// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/host/soak/report/soak_report.hpp"
#include "service/host/soak/segments.hpp"
#include "service/host/soak/watch/evidence.hpp"
#include "service/host/soak/watch/timeline.hpp"

namespace meridian::soak {

/// Checks the recording of a running service while it is written: the service writes into a pipe,
/// one thread cuts what comes out of it into segments, another checks each against its program
/// (record::check) and throws it away.
class Check {
 public:
  /// Makes the pipe in `folder`. Of the first kMaxKept segments with something wrong, recording
  /// and program are put into folder `kept`, anew; empty: none. Throws std::runtime_error.
  Check(const MachineModel& model, const ToolTable& tools, std::filesystem::path folder,
        const std::filesystem::path& kept);
  ~Check();
  Check(const Check&) = delete;
  Check& operator=(const Check&) = delete;

  /// Where a service is to record.
  [[nodiscard]] std::filesystem::path pipe() const { return folder_ / "recording.pipe"; }
  /// From now on (machine's clock, ns) the programs that begin are this one. A file that `is_ours`
  /// is removed when what the machine made of it has been checked.
  void announce(const std::string& program, bool is_ours, std::int64_t now_ns);
  /// From now on the operator's feed override is `factor`.
  void announce_override(double factor, std::int64_t now_ns);
  /// Adds what was checked since the last call.
  void collect(SoakReport& report);
  /// Reads what is left; call when no service writes any more.
  void finish();

 private:
  static constexpr int kMaxKept = 10;
  struct Checked {
    record::CheckReport check;
    std::string where, refusal;
  };
  void read_pipe();
  void check_segments();
  [[nodiscard]] Checked check(const Segment& segment);
  /// Puts the evidence aside where something is wrong, and says so.
  void keep(Checked& checked, const Segment& segment);

  const MachineModel& model_;
  const ToolTable& tools_;
  std::filesystem::path folder_;
  Evidence kept_;
  Segments segments_;
  std::mutex mutex_;  ///< of the four below
  SentPrograms programs_;
  AskedOverrides overrides_;
  std::deque<Segment> waiting_;
  std::vector<Checked> checked_;
  std::atomic<bool> is_read_{false}, is_ending_{false};
  std::thread reader_, checker_;
};

}  // namespace meridian::soak
