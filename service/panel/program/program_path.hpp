// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/kinematics.hpp"

namespace meridian::panel {

/// The path of a simulated program as a page draws it: points with the time, the feed and the limit
/// that held the feed there. Where there are too many points every other one goes: the memory is
/// bounded, whatever the length of the program. Proof: tests/panel/program_preview_test.cpp.
class ProgramPath {
 public:
  static constexpr std::size_t kMaxPoints = std::size_t{1} << 17U;

  /// As it lies in memory and in bytes(): 32-bit floats and integers, little endian.
  struct Point {
    float time_s = 0;                       ///< since the end of the approach
    float plan_time_s = 0;                  ///< as in the status
    std::array<float, 3> tip_mm{}, axis{};  ///< in the workpiece frame
    float feed_mm_per_min = 0;              ///< mean since the point before
    float programmed_mm_per_min = 0;
    std::uint32_t line = 0, block = 0;
    std::uint32_t limit = 0;                ///< simulate::LimitId
    std::uint32_t cause = kUndecided;       ///< simulate::Cause
    std::array<float, kMaxJoints> joints{};  ///< mm, rad
  };
  static constexpr std::uint32_t kUndecided = 255;

  /// What is known of a cycle beside its record.
  struct Cause {
    double time_s = 0;   ///< that the cycle took
    double path_mm = 0;  ///< of the tip in it
    double programmed_mm_per_s = 0;
    std::uint32_t limit = 0;
    std::uint32_t cause = kUndecided;
    double tool_length_mm = 0;
  };

  /// `model` must live on.
  explicit ProgramPath(const MachineModel& model) : model_(model) {}

  void add(const CycleRecord& record, const Cause& cause);
  /// The cause of the newest points, as far back as they have none.
  void decide(std::uint32_t cause) noexcept;

  [[nodiscard]] const std::vector<Point>& points() const noexcept { return points_; }
  /// All points, one after the other, as a page reads them.
  [[nodiscard]] std::string bytes() const;

 private:
  void halve();

  const MachineModel& model_;
  std::vector<Point> points_;
  std::uint64_t every_ = 1, since_ = 0;
  double time_s_ = 0, point_s_ = 0, path_mm_ = 0;
};

}  // namespace meridian::panel
