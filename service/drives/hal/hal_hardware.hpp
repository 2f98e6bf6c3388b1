// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/drive.hpp"
#include "service/drives/hal/period_grid.hpp"
#include "service/drives/hal/shared.h"

namespace meridian::hal {

/// The joints of LinuxCNC's HAL as the hardware of the library for drives, through shared memory.
/// RT in every function but the constructor and act(). Proof: tests/unit/hal/hal_hardware_test.cpp.
class HalHardware final : public drive::Hardware {
 public:
  /// Writes the set-up and begins after the setpoints that are there. `bridge_ns`: the component
  /// goes on so long without setpoints. `shared` outlives this.
  HalHardware(meridian_hal_shared& shared, const std::vector<drive::Axis>& axes,
              std::int64_t period_ns, std::int64_t bridge_ns);

  /// Whether HAL's servo thread reports, at `now_ns` of the monotonic clock. The first call takes
  /// the positions that the library asks for.
  [[nodiscard]] bool hear(std::int64_t now_ns) noexcept;

  [[nodiscard]] drive::Reading read(int axis) noexcept override;
  void write(int axis, const drive::Output& output) noexcept override;
  void exchange(double dt_s) noexcept override;
  [[nodiscard]] bool is_emergency_stop() noexcept override { return report_.is_stopped != 0; }
  [[nodiscard]] bool is_guard_open() noexcept override { return report_.is_guard_open != 0; }
  [[nodiscard]] drive::Probe probe() noexcept override;
  [[nodiscard]] drive::HomingStep home(int axis, const drive::HomingView& view) noexcept override;

  /// The library knows where the axis is: its index pulse is asked for no more.
  void set_referenced(int axis, bool is_referenced) noexcept;

  /// An action of the program; waits until HAL has done it, or was stopped: that one is over then.
  /// Another thread calls it. Returns why it failed; empty: done.
  [[nodiscard]] std::string act(const drive::Action& action, const std::atomic<bool>& is_stopping);

 private:
  enum class HomedPin : std::uint8_t {
    kOfBefore,  ///< high from before this search, or reported already
    kLow,       ///< what rises now is of this search
    kRisen      ///< the search has found a reference
  };
  struct Joint {
    drive::HomingMethod homing = drive::HomingMethod::kNone;
    double farthest_step = 0;  ///< in one period
    double position = 0;       ///< as HAL has it
    double hidden = 0;         ///< what a search has renamed and home() has not reported
    std::uint32_t index_count = 0;
    HomedPin homed_pin = HomedPin::kLow;
    bool is_on = false, is_referenced = false;
  };
  void take_report() noexcept;
  /// Returns the order's number.
  std::uint64_t give_order(meridian_hal_action action, double value) noexcept;

  meridian_hal_shared& shared_;
  std::vector<Joint> joints_;
  std::int64_t bridge_ns_;
  PeriodGrid grid_;
  double elapsed_s_ = 0;  ///< by the service's clock, of the axes alike
  meridian_hal_setpoint setpoint_{};
  meridian_hal_report report_{};
  std::int64_t heard_ns_ = 0;  ///< when the newest report came
  bool is_alive_ = false;
  std::atomic<bool> may_act_{false};
  std::atomic<std::uint64_t> order_over_{0};
  std::atomic<std::uint32_t> order_result_{0};  ///< of that one
};

}  // namespace meridian::hal
