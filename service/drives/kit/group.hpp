// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "meridian/drive_hardware.hpp"
#include "meridian/kinematics/joints.hpp"
#include "service/drives/kit/csp/following_axis.hpp"
#include "service/drives/kit/receiver.hpp"
#include "service/drives/kit/setpoint_age.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::drive {

/// One axis of a group: its limits, its index in drive order, how it homes, where it stands.
struct GroupAxis {
  JointSpec spec;
  HomingSpec homing;
  int joint = 0;
  double position = 0;
};

struct GroupSpec {
  std::vector<GroupAxis> axes;
  std::uint32_t number = 0;  ///< drive_group of the reports
  int joints = 0;            ///< of the whole machine; others may have the rest of them
  std::int64_t cycle_ns = 1'000'000;
  int bridge_cycles = 3;  ///< until the service says how many
};

/// Drives behind one wire: takes the service's setpoints and controlwords, works once per period,
/// reports feedback. It obeys one master (MasterPin), drops what others send, and checks what the
/// master sends: checksum, order and age here, limits in each axis (check_setpoint). It knows no
/// clock and no DDS entity. RT: nothing but the constructor allocates.
/// Proof: tests/unit/drive_kit/group_test.cpp, tests/unit/simulated_drives/drive_group_test.cpp.
class Group : public Receiver {
 public:
  explicit Group(const GroupSpec& spec);

  Drop take(const dds::DriveCommand& command, std::uint64_t sender) noexcept override;
  Drop take(const dds::SetpointSample& setpoint, std::uint64_t sender,
            std::int64_t arrival_ns) noexcept override;
  void take(const Bridge& bridge) noexcept override;
  void see_master(bool is_there) noexcept override;
  [[nodiscard]] const MasterPin& pin() const noexcept override { return pin_; }

  /// take() in two halves: whether a sample is one of the master's and in order, counted where it
  /// is not; and what it changes.
  Drop admit(const dds::DriveCommand& command, std::uint64_t sender) noexcept;
  void apply(const dds::DriveCommand& command) noexcept;
  Drop admit(const dds::SetpointSample& setpoint, std::uint64_t sender,
             std::int64_t arrival_ns) noexcept;
  Drop accept(const dds::SetpointSample& setpoint) noexcept;

  /// Works `periods` cycle times (more than 1 after a stall of this process).
  void work(int periods, Hardware& hardware) noexcept;
  /// Where the axes are, before the first period.
  void see(Hardware& hardware) noexcept;
  /// Returns the feedback of this period.
  [[nodiscard]] dds::DriveFeedback feedback() noexcept;

  /// No drive follows anything: off or in fault.
  [[nodiscard]] bool is_off() const noexcept;
  [[nodiscard]] FollowingAxis& axis(int index) noexcept {
    return axes_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const FollowingAxis& axis(int index) const noexcept {
    return axes_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(axes_.size()); }
  [[nodiscard]] double cycle_s() const noexcept { return cycle_s_; }
  [[nodiscard]] const DropCounts& dropped() const noexcept { return dropped_; }
  [[nodiscard]] std::uint64_t setpoints_seen() const noexcept { return setpoints_seen_; }
  [[nodiscard]] std::uint64_t periods_bridged() const noexcept { return periods_bridged_; }

 private:
  [[nodiscard]] Drop check(const dds::SetpointSample& setpoint, std::uint64_t sender,
                           std::int64_t arrival_ns) noexcept;
  void obey_new_master() noexcept;
  void see_inputs(Hardware& hardware) noexcept;
  [[nodiscard]] AxisInput input_of(std::size_t joint, int periods) const noexcept;
  [[nodiscard]] double capped_s(std::uint64_t cycles) const noexcept;
  [[nodiscard]] double elapsed_s() const noexcept;
  [[nodiscard]] double advance_s(int periods) noexcept;
  /// So many periods are led on by the velocity of before, and no longer than the bridge.
  [[nodiscard]] int bridged(int periods) const noexcept {
    return std::min(periods, bridge_cycles_);
  }

  std::vector<FollowingAxis> axes_;
  std::vector<std::size_t> joints_;        ///< of the axes
  std::array<int, kMaxJoints> axis_of_{};  ///< -1: of another group
  std::uint32_t number_, joint_mask_ = 0;
  int machine_joints_;
  double cycle_s_;
  int bridge_cycles_;
  int own_bridge_cycles_;            ///< of GroupSpec
  std::array<Bridge, 8> bridges_{};  ///< of the newest services, one a participant, in a ring
  std::size_t next_bridge_ = 0;
  MasterPin pin_;
  DropCounts dropped_;
  SetpointAge age_;
  dds::SetpointSample newest_;
  bool has_setpoint_ = false, is_new_ = false;
  int periods_without_ = 0;           ///< since the newest setpoint
  int periods_slept_ = 0;             ///< of this side's last stall, not in periods_without_ yet
  std::uint64_t followed_cycle_ = 0;  ///< of the setpoint that the drives worked with last
  std::uint64_t reached_cycle_ = 0;   ///< to which setpoint or bridge has led the axes
  std::int64_t periods_since_ = 0;    ///< own periods since then
  std::uint64_t sample_ = 0, setpoints_seen_ = 0, periods_bridged_ = 0;
  bool is_emergency_stop_ = false, is_guard_open_ = false;
  ProbeInput probe_ = ProbeInput::kNone;
};

}  // namespace meridian::drive
