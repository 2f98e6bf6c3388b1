// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/cycle/step.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/daemon/monitoring/cycle_monitor.hpp"
#include "service/daemon/ports/cycle_clock.hpp"
#include "service/daemon/ports/ports.hpp"

namespace meridian::interpolator {

/// The fixed-rate loop: sleep, step(), hand over. Never calls DDS, allocates, locks or logs; its
/// system calls are the sleep and the publisher's wake. Proof: tests/integration/counters_test.cpp.
class CycleThread {
 public:
  CycleThread(const MachineModel& model, const CycleOptions& options,
              const monitoring::Limits& limits, Ports& ports) noexcept;

  /// Before run(): where the workpiece lies.
  void set_up(const SetUpInForce& in_force) noexcept { apply_set_up(model_, in_force); }
  /// Runs until Ports::is_stopping.
  void run() noexcept;

 private:
  /// Takes over the work frame that an accepted word puts in force, from the next period on.
  void take_set_up() noexcept;
  void gather(const Period& period, std::int64_t now_ns) noexcept;
  void hand_over() noexcept;
  void show() noexcept;
  void show_drives_asked() noexcept;
  void watch_enabling(std::int64_t now_ns) noexcept;
  /// Holds what an open guard forbids, and slows down the jog.
  void watch_guard() noexcept;
  void report_spans() noexcept;

  MachineModel model_;
  Ports& ports_;
  CycleState state_;
  MotionReader motion_;
  CycleInputs inputs_;
  StepOutput output_;
  CycleMonitor monitor_;
  CycleView view_;
  DrivesAsked drives_asked_;  ///< as it was shown last
  std::int32_t computation_ns_ = 0;
  struct Times {
    std::int64_t woke_ns = 0, gathered_ns = 0, computed_ns = 0, handed_ns = 0;
  } times_;  ///< of this cycle; gathered_ns only where it is traced
  trace::SpanWriter spans_;
};

}  // namespace meridian::interpolator
