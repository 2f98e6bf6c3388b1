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
#include "service/soak/segments.hpp"
#include "service/soak/soak_report.hpp"

namespace meridian::soak {

/// Judges the recording of a running service while it is written: the service writes into a pipe,
/// one thread cuts what comes out of it into segments, another judges each against its program
/// (record::check) and throws it away.
class Judge {
 public:
  /// Makes the pipe in `folder`. Throws std::runtime_error.
  Judge(const MachineModel& model, const ToolTable& tools, std::filesystem::path folder);
  ~Judge();
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  /// Where a service is to record.
  [[nodiscard]] std::filesystem::path pipe() const { return folder_ / "recording.pipe"; }
  /// From now on (machine's clock, ns) the programs that begin are this one.
  void announce(const std::string& program, std::int64_t now_ns);
  /// From now on the operator's feed override is `factor`.
  void announce_override(double factor, std::int64_t now_ns);
  /// Adds what was judged since the last call.
  void collect(SoakReport& report);
  /// Reads what is left; call when no service writes any more.
  void finish();

 private:
  struct Judged {
    record::CheckReport check;
    std::string where, refusal;
  };
  struct Program {
    std::string file;
    std::int64_t since_ns = 0;
  };
  struct Override {
    double factor = 1;
    std::int64_t since_ns = 0;
  };
  void read_pipe();
  void judge_segments();
  [[nodiscard]] Judged judge(const Segment& segment);
  [[nodiscard]] std::string program_at(std::int64_t time_ns);
  /// Highest feed override since `time_ns`, at least 1.
  [[nodiscard]] double most_override_since(std::int64_t time_ns);

  const MachineModel& model_;
  const ToolTable& tools_;
  std::filesystem::path folder_;
  Segments segments_;
  std::mutex mutex_;  ///< of the four below
  std::vector<Program> programs_;
  std::vector<Override> overrides_;
  std::deque<Segment> waiting_;
  std::vector<Judged> judged_;
  std::atomic<bool> is_read_{false}, is_ending_{false};
  std::thread reader_, checker_;
};

}  // namespace meridian::soak
