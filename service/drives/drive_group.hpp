// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/dds/messages.hpp"
#include "service/drives/drive.hpp"
#include "service/drives/injection.hpp"
#include "service/drives/master.hpp"
#include "service/drives/report_faults.hpp"
#include "service/drives/report_wire.hpp"
#include "service/drives/setpoint_age.hpp"
#include "service/drives/setpoint_faults.hpp"

namespace meridian::drives {

/// All drives of a machine behind one wire: takes the service's setpoints and controlwords, works
/// once per period, reports feedback. It obeys one master (MasterPin), drops what others send, and
/// checks what the master sends: checksum, order and age here, limits in each drive
/// (check_setpoint).
/// Proof: tests/unit/drives/drive_group_test.cpp.
class DriveGroup {
 public:
  /// Drives stand where the joints are at home. `homing`, in drive order, may lack the last ones:
  /// they know where they are.
  DriveGroup(const MachineModel& model, const ServoLag& lag,
             const std::vector<HomingPlan>& homing = {});

  /// `sender`: dds::participant_of() its writer; 0: not known.
  Drop take(const dds::DriveCommand& command, std::uint64_t sender) noexcept;
  /// `arrival_ns`: by the receiver's clock; 0: not known, and age is not checked.
  Drop take(const dds::SetpointSample& setpoint, std::uint64_t sender,
            std::int64_t arrival_ns = 0) noexcept;
  /// Once a period, before work(): whether DDS still knows the master's writer.
  void see_master(bool is_there) noexcept;
  /// How many periods are bridged says the master: what others say under its id counts for nothing.
  void take(const dds::MachineInfo& machine, std::uint64_t sender) noexcept;
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

  [[nodiscard]] const Drive& drive(int index) const noexcept { return drives_[index]; }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(drives_.size()); }
  [[nodiscard]] const MasterPin& pin() const noexcept { return pin_; }
  [[nodiscard]] const DropCounts& dropped() const noexcept { return dropped_; }
  [[nodiscard]] std::uint64_t setpoints_seen() const noexcept { return setpoints_seen_; }
  [[nodiscard]] std::uint64_t periods_bridged() const noexcept { return periods_bridged_; }

 private:
  [[nodiscard]] bool is_off() const noexcept;
  [[nodiscard]] Drop check(const dds::SetpointSample& setpoint, std::uint64_t sender,
                           std::int64_t arrival_ns) noexcept;
  Drop accept(const dds::SetpointSample& setpoint) noexcept;
  void obey_new_master() noexcept;
  [[nodiscard]] double elapsed_s() const noexcept;
  void mend() noexcept;
  void work_on_injections(double dt_s) noexcept;

  std::vector<Drive> drives_;
  std::vector<Injection> injections_;
  double cycle_s_;
  int bridge_cycles_;
  struct Bridge {
    Master by;
    int cycles = 0;
  };
  int own_bridge_cycles_;            ///< of the machine file
  std::array<Bridge, 8> bridges_{};  ///< of the newest services, one a participant, in a ring
  std::size_t next_bridge_ = 0;
  MasterPin pin_;
  DropCounts dropped_;
  SetpointAge age_;
  dds::SetpointSample newest_;
  bool has_setpoint_ = false, is_new_ = false;
  int periods_without_ = 0;  ///< since the newest setpoint
  int bridge_left_ = 0;      ///< periods for which the newest setpoint's velocity still leads on
  int periods_slept_ = 0;    ///< of this side's last stall, not in periods_without_ yet
  std::uint64_t followed_cycle_ = 0;  ///< of the setpoint that the drives worked with last
  std::int64_t periods_since_ = 0;    ///< own periods since then
  double enabled_s_ = 0;
  std::uint64_t sample_ = 0, setpoints_seen_ = 0, periods_bridged_ = 0;
  bool is_silent_ = false, is_dead_ = false, is_emergency_stop_ = false;
  ReportFaults report_faults_;
  ReportWire report_wire_;
  bool has_reported_ = false;  ///< in this period
  SetpointFaults setpoint_faults_;
};

}  // namespace meridian::drives
