// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/kit/group.hpp"
#include "service/drives/simulated/injection.hpp"
#include "service/drives/simulated/report_faults.hpp"
#include "service/drives/simulated/report_wire.hpp"
#include "service/drives/simulated/setpoint_faults.hpp"
#include "service/drives/simulated/simulated_servos.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::drives {

/// All drives of a simulated machine behind one wire: the library's group over simulated servos,
/// and everything that may go wrong on purpose with drives and wire.
/// Proof: tests/unit/simulated_drives/drive_group_test.cpp.
class DriveGroup : public drive::Receiver {
 public:
  /// Drives stand where the joints are at home. `homing`, in drive order, may lack the last ones:
  /// they know where they are.
  DriveGroup(const MachineModel& model, const ServoLag& lag,
             const std::vector<HomingPlan>& homing = {});

  drive::Drop take(const dds::DriveCommand& command, std::uint64_t sender) noexcept override;
  drive::Drop take(const dds::SetpointSample& setpoint, std::uint64_t sender,
                   std::int64_t arrival_ns = 0) noexcept override;
  void take(const drive::Bridge& bridge) noexcept override { group_.take(bridge); }
  void see_master(bool is_there) noexcept override { group_.see_master(is_there); }
  /// A probe is in the spindle from now on.
  void connect(const SimulatedProbe& probe) { servos_.connect(probe); }
  /// Goes wrong when its time has come.
  void inject(const Injection& injection) { injections_.push_back(injection); }
  /// Goes wrong now.
  void inject_now(const Injection& injection) noexcept;

  /// Works `periods` cycle times (more than 1 after a stall of this process).
  void work(int periods) noexcept;

  /// Returns the feedback of this period.
  [[nodiscard]] dds::DriveFeedback feedback() noexcept;
  /// A report that the wire brings in this period, once it has been worked; call until there is
  /// none.
  [[nodiscard]] bool reports(dds::DriveFeedback& feedback);
  [[nodiscard]] bool is_silent() const noexcept { return is_silent_ || is_dead_; }

  [[nodiscard]] const drive::FollowingAxis& drive(int index) const noexcept {
    return group_.axis(index);
  }
  [[nodiscard]] int size() const noexcept { return group_.size(); }
  [[nodiscard]] const drive::MasterPin& pin() const noexcept override { return group_.pin(); }
  [[nodiscard]] const drive::DropCounts& dropped() const noexcept { return group_.dropped(); }
  [[nodiscard]] std::uint64_t setpoints_seen() const noexcept { return group_.setpoints_seen(); }
  [[nodiscard]] std::uint64_t periods_bridged() const noexcept { return group_.periods_bridged(); }

 private:
  void mend() noexcept;
  void work_on_injections(double dt_s) noexcept;

  SimulatedServos servos_;
  drive::Group group_;
  std::vector<Injection> injections_;
  double enabled_s_ = 0;
  bool is_silent_ = false, is_dead_ = false, is_emergency_stop_ = false, is_guard_open_ = false;
  ReportFaults report_faults_;
  ReportWire report_wire_;
  bool has_reported_ = false;  ///< in this period
  SetpointFaults setpoint_faults_;
};

}  // namespace meridian::drives
