// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/scene/limit_shares.hpp"

namespace meridian::panel {

/// What a page draws of the setpoints that went over the wire since its last frame: the trail of
/// the tip, how near every joint came to its limits, how far the drives are behind. Fixed memory;
/// one thread. Units: mm, rad, s. Proof: tests/panel/panel_unit_test.cpp.
class Motion {
 public:
  /// A point of the trail, in the workpiece frame.
  struct TrailPoint {
    Pose<double> pose;
    std::uint32_t line = 0;
  };
  /// One sent cycle, for the scope.
  struct Sample {
    std::uint64_t cycle = 0;
    JointVector joints{};
    JointVector following{};   ///< setpoint less feedback, drive coordinates; 0 where not known
    double feed_mm_per_s = 0;  ///< of the tip; 0 after a lost cycle
  };
  /// `model` must live on. Every `trail_every` cycles a point of the trail.
  explicit Motion(const MachineModel& model, int trail_every = 8);

  /// Takes the next setpoint; older ones than the last are passed over.
  void add(const Setpoint& setpoint);
  /// Takes the setpoints since the status before; `tool_length_mm` is the tool at their end. Tools
  /// change at rest, so another tool than before is in use from the last rest on.
  void add(std::span<const Setpoint> setpoints, double tool_length_mm);
  /// Takes feedback: `cycle_seen` names the setpoint that it is compared with.
  void add_feedback(std::uint64_t cycle_seen, std::uint32_t joint_mask,
                    const JointVector& position);

  [[nodiscard]] const std::vector<TrailPoint>& trail() const noexcept { return trail_; }
  [[nodiscard]] const std::vector<Sample>& samples() const noexcept { return samples_; }
  [[nodiscard]] const scene::Shares& shares() const noexcept { return shares_.largest(); }
  [[nodiscard]] const JointVector& following() const noexcept { return following_; }
  /// Joints of the newest setpoint; nothing before the first.
  [[nodiscard]] const std::optional<JointVector>& joints() const noexcept { return joints_; }
  /// A frame was made of it: trail, samples and shares begin anew.
  void clear();

 private:
  static constexpr std::size_t kKept = 512;  ///< setpoints that feedback is compared with
  struct Sent {
    std::uint64_t cycle = 0;
    JointVector position{};
  };
  /// The tip is now at the end of another tool: that is no path.
  void set_tool_length(double tool_length_mm) noexcept;

  const MachineModel& model_;
  int trail_every_;
  double tool_length_mm_;
  std::uint64_t cycle_ = 0;
  std::array<Sent, kKept> sent_{};
  std::optional<JointVector> joints_;
  Vector3 tip_ = Vector3::Zero();
  JointVector following_{};
  scene::LimitShares shares_;
  std::vector<TrailPoint> trail_;
  std::vector<Sample> samples_;
};

}  // namespace meridian::panel
