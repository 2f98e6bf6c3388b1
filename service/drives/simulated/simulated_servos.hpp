// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "meridian/drive_hardware.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/simulated/homing_search.hpp"
#include "service/drives/simulated/probed_part.hpp"
#include "service/drives/simulated/servo.hpp"

namespace meridian::drives {

/// One motor behind its servo: lag, a shaft that may be stuck, a power stage that may go off, and
/// the search for its reference switch.
struct SimulatedServo {
  /// It stands at `home`, or beside it without a reference (HomingPlan).
  SimulatedServo(const JointSpec& spec, const HomingPlan& plan);

  ServoState servo;
  HomingSearch search;
  drive::Output output;
  bool is_blocked = false, has_power = true;
  std::optional<double> sick_time_constant_s;  ///< nothing: follows as it is
};

/// The motors of a simulated machine, as a library for drives sees them: one step of the servos in
/// every exchange. Proof: tests/unit/simulated_drives/drive_test.cpp.
class SimulatedServos : public drive::Hardware {
 public:
  explicit SimulatedServos(const ServoLag& lag) : lag_(lag) {}
  void add(const JointSpec& spec, const HomingPlan& plan) { servos_.emplace_back(spec, plan); }
  void connect(const SimulatedProbe& probe) { probe_ = probe; }
  [[nodiscard]] SimulatedServo& servo(std::size_t axis) noexcept { return servos_[axis]; }
  [[nodiscard]] std::size_t size() const noexcept { return servos_.size(); }

  [[nodiscard]] drive::Reading read(int axis) noexcept override;
  void write(int axis, const drive::Output& output) noexcept override;
  void exchange(double dt_s) noexcept override;
  [[nodiscard]] drive::HomingStep home(int axis, const drive::HomingView& view) noexcept override;
  [[nodiscard]] drive::Probe probe() noexcept override;

 private:
  ServoLag lag_;
  std::vector<SimulatedServo> servos_;
  std::optional<SimulatedProbe> probe_;
};

/// How the library homes such a drive: the simulation leads it.
[[nodiscard]] drive::HomingSpec homing_of(const HomingPlan& plan);

}  // namespace meridian::drives
