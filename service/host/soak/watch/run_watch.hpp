// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>

#include "meridian/kinematics/machine_model.hpp"
#include "service/host/soak/report/fault_check.hpp"
#include "service/host/soak/watch/health_watch.hpp"
#include "service/host/soak/watch/host_credit.hpp"
#include "service/host/soak/watch/host_watch.hpp"
#include "service/host/soak/watch/overrun_excuse.hpp"
#include "service/host/soak/watch/status_counts.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::soak {

/// Whether the machine moves in a program.
[[nodiscard]] constexpr bool is_moving(State state) noexcept {
  return state == State::kApproaching || state == State::kRunning;
}

/// Everything that is seen of a run beside its setpoints: what the service counts and how it
/// stands, what the host does to it, and whose doing a Fault is. Fills the report.
class RunWatch {
 public:
  /// `model`: with the bridge of this run. `report` is filled and must stay; its `cpu` is watched.
  RunWatch(dds::Participant& participant, const MachineModel& model, SoakReport& report);

  /// A service was started.
  void begin_life(double now_s);
  /// Knows which faults drives are given, and when they come and go.
  [[nodiscard]] FaultCheck& faults() { return faults_; }
  /// New drives have said nothing yet.
  void forget_feedback() { feedback_ = {}; }

  /// Every status in its order; the cause of a Fault once, as soon as it is known.
  [[nodiscard]] std::optional<FaultCheck::Cause> see(const dds::Status& status, double now_s);
  /// Once a second while process `service` runs.
  void look(pid_t service, double now_s);
  /// What the host did until now, into the report.
  void report_host();

 private:
  void count(const dds::Status& status, double now_s);
  [[nodiscard]] bool has_stall_of_late() const;
  [[nodiscard]] bool misses_setpoints();

  SoakReport& report_;
  HealthWatch health_;
  static constexpr int kFeedbackDepth = 16;
  dds::Reader<dds::DriveFeedback> feedback_reader_;
  dds::DriveFeedback feedback_;  ///< the newest
  std::int64_t bridge_ns_;       ///< what drives bridge
  HostWatch host_;
  FaultCheck faults_;
  HostCredit credit_;
  OverrunExcuse excuse_;
  StatusCounts counts_;
  Histogram bare_;                     ///< lateness of the witness, as far as it is taken
  std::optional<dds::Status> newest_;  ///< of this life
};

}  // namespace meridian::soak
