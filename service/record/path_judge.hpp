// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/record/check.hpp"
#include "service/record/path_follower.hpp"
#include "service/record/speed_judge.hpp"
#include "service/record/time_judge.hpp"

namespace meridian::record {

/// Judges the tool against the path: deviation, vertices, speeds, times of blocks. Rows
/// of the cut alone, in order. Units: mm, rad, s.
class PathJudge {
 public:
  /// Both tolerances of `options` are in force.
  PathJudge(const MachineModel& model, const CheckedPath& path, const CheckOptions& options);

  void add(const RecordingRow& row);
  /// Judges what is left and adds what was found to the report.
  void finish(CheckReport& report);

 private:
  struct Place {
    std::uint64_t cycle = 0;
    std::uint32_t line = 0;
    JointVector joints{};
  };
  void step(bool has_between);
  void sample(const JointVector& joints, const Place& place, bool is_setpoint);
  PoseMatch match(const JointVector& joints, ToolPose& pose);
  void pass_vertices(const ToolPose& pose);
  [[nodiscard]] bool pass_vertex(std::size_t index);
  [[nodiscard]] double miss_of_turn(const ToolPose& vertex) const;
  void add_gap(double s_from, double s_to);
  [[nodiscard]] double vertex_s(std::size_t index) const noexcept;
  [[nodiscard]] ToolPose vertex(std::size_t index) const noexcept;
  [[nodiscard]] std::uint32_t vertex_line(std::size_t index) const noexcept;
  [[nodiscard]] bool is_turn(std::size_t index) const noexcept;
  [[nodiscard]] double axis_tolerance_at(const Vector3& axis) const noexcept;
  [[nodiscard]] double reach_of_match() const noexcept;
  void finish_vertices(CheckReport& report) const;

  const MachineModel& model_;
  const CheckedPath& path_;
  CheckOptions options_;
  double tip_tolerance_, axis_tolerance_;
  double allowed_axis_ = 0;   ///< at the last sample
  double exceeded_axis_ = 0;  ///< what was allowed where the axis was farthest off
  PathFollower follower_;
  SpeedJudge speeds_;
  TimeJudge times_;
  double tool_length_;
  std::array<Place, 4> places_{};  ///< newest last
  bool is_under_way_ = false;      ///< the first step may begin in the approach
  int known_ = 0;                  ///< how many of them are filled
  int run_ = 0;                    ///< consecutive cycles at their end
  PoseMatch here_{};
  double reached_ = 0;               ///< largest matched length so far
  std::size_t last_element_ = 0;     ///< of the match before here_
  std::array<ToolPose, 3> poses_{};  ///< the last samples without a gap, newest last
  int pose_count_ = 0;
  std::vector<double> nearest_;  ///< of each vertex: least distance to the tip's way
  std::vector<double> turned_;   ///< of those at a turn of the axis alone: in tolerances, both
  std::vector<bool> in_gap_;     ///< passed while cycles are missing
  Peak tip_, axis_, tip_between_, axis_between_;
  Excess tip_over_, axis_over_;
};

}  // namespace meridian::record
