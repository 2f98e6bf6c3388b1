// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/kinematics/limited.hpp"

namespace meridian::record {

/// The largest value of something, and where it was.
struct Peak {
  double value = 0;
  std::uint64_t cycle = 0;
  std::uint32_t line = 0;

  void raise(double candidate, std::uint64_t at_cycle, std::uint32_t at_line) noexcept {
    if (candidate > value) *this = {candidate, at_cycle, at_line};
  }
};

/// What was larger than it may be: the worst of it, and how often it was seen.
struct Excess {
  Peak worst;
  std::uint64_t count = 0;

  void add(double value, std::uint64_t at_cycle, std::uint32_t at_line) noexcept {
    worst.raise(value, at_cycle, at_line);
    ++count;
  }
};

/// By this share of a bound rounding alone may be beyond it.
inline constexpr double kRoundingShare = 1e-6;

/// What a joint made of its limits: 1 is the limit.
struct JointUse {
  Peak velocity, acceleration, jerk;
  double low = 0, high = 0;  ///< extreme positions, mm or rad
};

/// How the recording stands to the machine's actuator stage.
struct StageUse {
  Peak apart_mm;              ///< recorded drives from those of the recorded joints
  double determinant_mm = 0;  ///< least |d(u1, u2)/d(s, φ)|, mm/rad: distance from a dead point
};

/// Something that must not be, once for each kind with the number of cycles it was seen in.
struct Finding {
  enum class Kind : std::uint8_t {
    kEmpty,
    kMissingCycles,
    kCycleOrder,
    kDueGrid,
    kTip,
    kAxis,
    kVertex,
    kOrder,
    kUnfinished,
    kFeed,
    kCreep,
    kTurnRate,
    kBlockTime,
    kVelocity,
    kAcceleration,
    kJerk,
    kTravel,
    kSentVelocity,
    kStage,
    kRewind,
    kDryAndFollowed
  };
  Kind kind{};
  std::string text;         ///< a sentence with value, place and bound
  std::uint64_t cycle = 0;  ///< of the worst
  std::uint32_t line = 0;   ///< source line being cut there
  std::uint64_t count = 0;  ///< how many cycles (vertices, ...)
};

/// Short word of a kind of finding, as in the JSON report: "tip", "jerk", ...
[[nodiscard]] std::string_view word(Finding::Kind kind) noexcept;

/// The verdict on a recording. Units: mm, rad, s.
struct CheckReport {
  std::string recording, path_name;
  std::uint64_t rows = 0, cycles = 0, missing = 0, longest_gap = 0;
  double cycle_s = 0, span_s = 0;
  std::uint64_t begin_cycle = 0, end_cycle = 0;  ///< first and last of the cut
  double cut_s = 0;
  bool has_later_program = false;  ///< which is not checked against the path
  std::uint64_t motion_blocks = 0;
  double tip_length_mm = 0;
  double tip_tolerance_mm = 0, axis_tolerance_rad = 0;
  double pole_tolerance_rad = 0;          ///< of the axis within kPoleReach_rad of the pole
  Peak tip_mm, axis_rad;                  ///< at the setpoints
  Peak tip_between_mm, axis_between_rad;  ///< at three points between neighbouring setpoints
  Peak vertex_mm;                         ///< `line`: of the block that ends there
  std::uint64_t vertices = 0, vertices_in_gaps = 0;
  std::uint64_t rewinds = 0;  ///< turns of the redundant joint off the part
  Peak feed;                  ///< tip speed / programmed feed
  Peak tip_speed_mm_per_s;
  Peak sent_velocity;  ///< error of the velocity columns / what the jerk limit allows
  std::uint64_t fault_stop_cycles = 0;
  std::uint64_t dry_cycles = 0;      ///< of a dry run: no drive followed
  std::uint64_t dry_cut_cycles = 0;  ///< those of the cut
  bool has_stage = false;
  StageUse stage;
  int joint_count = 0;  ///< the drives of the stage are counted
  std::array<std::string, kMaxLimited> joint_names;
  std::array<bool, kMaxLimited> is_rotary{};
  std::array<JointUse, kMaxLimited> joints;
  std::vector<Finding> findings;

  [[nodiscard]] bool passed() const noexcept { return findings.empty(); }
};

/// The report for a person; ends in a line PASS or FAIL: reasons.
[[nodiscard]] std::string to_text(const CheckReport& report);
/// The same as one JSON object; lengths mm, angles deg, times s, units in the names.
[[nodiscard]] std::string to_json(const CheckReport& report);

}  // namespace meridian::record
