// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "meridian/drive_hardware.hpp"

namespace meridian::test {

/// Motors that stand at once where they are commanded, and report what a test wants.
class ScriptedHardware : public drive::Hardware {
 public:
  [[nodiscard]] drive::Reading read(int axis) noexcept override {
    return readings[static_cast<std::size_t>(axis)];
  }
  void write(int axis, const drive::Output& output) noexcept override {
    const auto i = static_cast<std::size_t>(axis);
    outputs[i] = output;
    if (output.is_on && !is_stuck && !output.is_homing) readings[i].position = output.position;
  }
  void exchange(double dt_s) noexcept override { exchanged_s += dt_s; }
  [[nodiscard]] bool is_emergency_stop() noexcept override { return is_stop_open; }
  [[nodiscard]] bool is_guard_open() noexcept override { return is_a_guard_open; }
  [[nodiscard]] drive::Probe probe() noexcept override { return touch_probe; }
  [[nodiscard]] drive::HomingStep home(int axis, const drive::HomingView& view) noexcept override {
    last_axis = axis;
    last_view = view;
    drive::HomingStep step = next_step;
    step.target += view.target;
    return step;
  }

  std::array<drive::Reading, 6> readings{};
  std::array<drive::Output, 6> outputs{};
  drive::HomingStep next_step;  ///< `target`: how far from the last one
  drive::HomingView last_view;
  int last_axis = -1;
  bool is_stuck = false, is_stop_open = false, is_a_guard_open = false;
  drive::Probe touch_probe = drive::Probe::kNone;
  double exchanged_s = 0;
};

}  // namespace meridian::test
