// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/panel/motion.hpp"

namespace meridian::panel {

/// A run as one HTML file that opens without a server or a network: the machine, its path coloured
/// by what holds the feed, joints and speeds against their limits, all of it over time.
///
/// Cycles are gathered in samples that double their distance where they become too many: the file
/// does not grow with the program. Of the shares of limits each sample has the largest.
/// Units: mm, rad, s. Proof: tests/panel/run_view_test.cpp.
class RunView {
 public:
  static constexpr std::size_t kMaxSamples = 12000;

  static constexpr std::uint8_t kUndecided = 255;

  /// What is known of a cycle beside its setpoint.
  struct Cause {
    double programmed_mm_per_s = 0;  ///< 0: no feed is programmed
    std::uint8_t limit = 0;          ///< index in `limits` of html()
    std::uint8_t cause = kUndecided;  ///< simulate::Cause
    double tool_length_mm = 0;
  };

  /// `model` must live on.
  explicit RunView(const MachineModel& model);

  /// The next cycle that was sent.
  void add(const Setpoint& setpoint, const Cause& cause);
  /// The cause of the newest cycles, as far back as they have none.
  void decide(std::uint8_t cause) noexcept;

  /// What the file says beside the picture.
  struct Words {
    std::string title;                  ///< program and machine
    std::vector<std::string> limits;    ///< names; the first means nothing held
    std::vector<std::string> findings;  ///< what is wrong, a line each
    std::string summary;                ///< the report as the command prints it
  };
  /// The whole file; empty where this build has no page.
  [[nodiscard]] std::string html(const ToolTable& tools, const Words& words) const;

  [[nodiscard]] std::size_t sample_count() const noexcept { return samples_.size(); }

 private:
  struct Sample {
    double time_s = 0;
    JointVector joints{};
    Pose<double> pose;
    double feed_mm_per_s = 0;
    std::uint32_t line = 0;
    Cause cause;
    std::array<float, kMaxJoints> shares{};  ///< largest of velocity, acceleration and jerk
  };
  void keep(const Setpoint& setpoint, const Cause& cause, const Pose<double>& pose);
  void halve();

  const MachineModel& model_;
  Motion motion_;
  std::vector<Sample> samples_;
  std::uint64_t every_ = 1, since_ = 0, first_cycle_ = 0, kept_cycle_ = 0;
  double path_mm_ = 0;  ///< of the tip since the last sample
  Vector3 tip_ = Vector3::Zero();
  double tool_length_mm_ = 0;  ///< that `tip_` is of
  bool has_begun_ = false;
};

}  // namespace meridian::panel
