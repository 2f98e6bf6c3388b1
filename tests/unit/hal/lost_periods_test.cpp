// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <utility>

#include "service/drives/hal/component/follow.h"
#include "service/drives/hal/period_grid.hpp"
#include "service/drives/kit/group.hpp"
#include "unit/drive_kit/scripted_hardware.hpp"

/// The library for drives and the component of HAL together, without a clock: what is on the pins
/// when a service dies in motion and the process between them loses periods.
namespace meridian::hal {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr int kBridge = 50;                              // periods: 50 ms, as in best effort
constexpr double kVelocity = 150, kAcceleration = 6000;  // mm/s, mm/s²

drive::GroupSpec one_axis() {
  drive::GroupSpec spec;
  spec.bridge_cycles = kBridge;
  drive::GroupAxis axis;
  axis.spec.limits.velocity = 300;
  axis.spec.limits.fault_acceleration = kAcceleration;
  axis.spec.limits.following_error = 5;
  spec.axes.push_back(axis);
  return spec;
}

class Chain {
 public:
  Chain() {
    setup_.joints = 1;
    setup_.period_ns = kPeriod_ns;
    setup_.bridge_ns = kBridge * kPeriod_ns;
    setup_.fault_acceleration[0] = kAcceleration;
    process_period(1);
    hal_period();
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
      command(word);
    }
  }
  /// One period of everything; the service speaks where it is alive, the process works where it is
  /// not held up, and makes up for what it has lost; HAL's thread too.
  void period(bool is_service_alive, bool is_process_held, bool is_hal_held = false) {
    now_ns_ += kPeriod_ns;
    if (is_service_alive) send();
    ++waiting_;
    if (!is_process_held) process_period(std::exchange(waiting_, 0));
    now_ns_ += kPeriod_ns / 2;
    if (!is_hal_held) hal_period();
    if (motors_.is_stuck) motors_.readings[0].position = position();
    now_ns_ -= kPeriod_ns / 2;
  }
  void command(std::uint16_t word) {
    dds::DriveCommand command;
    command.controlword = word;
    command.service_id = kService;
    (void)group_.take(command, kMaster);
  }
  /// Joints without lag, which are reported as HAL's thread saw them last.
  void report_by_hal() { motors_.is_stuck = true; }
  [[nodiscard]] std::uint16_t error() const { return group_.axis(0).error(); }
  [[nodiscard]] bool is_on() const { return motors_.outputs[0].is_on; }
  [[nodiscard]] bool has_power_stage_on() const {
    return follow_.phase[0] == MERIDIAN_HAL_FOLLOWS || follow_.phase[0] == MERIDIAN_HAL_RAMPS;
  }
  [[nodiscard]] double velocity() const { return follow_.velocity[0]; }
  [[nodiscard]] double position() const { return follow_.position[0]; }

 private:
  static constexpr std::uint64_t kMaster = 41, kService = 7;

  void send() {
    dds::SetpointSample sample;
    sample.setpoint.cycle = ++cycle_;
    sample.setpoint.flags = kSetpointEnabled;
    sample.setpoint.position[0] = sent_ += kVelocity * 1e-3;
    sample.setpoint.velocity[0] = kVelocity;
    sample.crc = dds::setpoint_crc(sample.setpoint, kService);
    (void)group_.take(sample, kMaster, 0);
  }
  void process_period(int periods) {
    group_.work(periods, motors_);
    const drive::Output& output = motors_.outputs[0];
    const double dt_s = output.is_on ? output.elapsed_s : 1e-3 * periods;
    meridian_hal_setpoint setpoint{};
    setpoint.number = ++number_;
    setpoint.end_ns = grid_.end_of(now_ns_, dt_s);
    setpoint.position[0] = output.position;
    setpoint.velocity[0] = output.velocity;
    setpoint.on_mask = output.is_on ? 1 : 0;
    meridian_hal_write(&shared_.setpoint_lock, &shared_.setpoints[number_ % MERIDIAN_HAL_KEPT],
                       &setpoint, sizeof setpoint);
  }
  void hal_period() {
    const double feedback[MERIDIAN_HAL_JOINTS] = {position()};
    meridian_hal_step(&follow_, &shared_, &setup_, now_ns_, kPeriod_ns, feedback);
  }

  std::int64_t now_ns_ = 1'000'000'000;
  std::uint64_t cycle_ = 100, number_ = 0;
  double sent_ = 0;
  int waiting_ = 0;
  drive::Group group_{one_axis()};
  test::ScriptedHardware motors_;
  PeriodGrid grid_{kPeriod_ns};
  meridian_hal_shared shared_{};
  meridian_hal_setup setup_{};
  meridian_hal_follow follow_{};
};

/// The largest acceleration over 5 ms on the pin of the velocity, as the test on HAL's own sampler
/// has it, from the death of the service to rest.
double hardest_stop(int held_from, int held_for) {
  Chain chain;
  for (int n = 0; n < 100; ++n) chain.period(true, false);
  std::deque<double> kept;
  double hardest = 0;
  for (int n = 0; n < 300; ++n) {
    chain.period(false, n >= held_from && n < held_from + held_for);
    kept.push_back(chain.velocity());
    if (kept.size() <= 5) continue;
    hardest = std::max(hardest, std::abs(kept.back() - kept.front()) / 5e-3);
    kept.pop_front();
  }
  EXPECT_EQ(chain.velocity(), 0);
  return hardest;
}

TEST(LostPeriods, AStopIsNoHarderWhereTheProcessLosesSomeInTheBridgeOrInTheRamp) {
  double hardest = 0;
  for (int from = 0; from < 90; ++from) {
    for (int lost = 0; lost <= 20; ++lost) hardest = std::max(hardest, hardest_stop(from, lost));
  }
  EXPECT_LE(hardest, 1.25 * kAcceleration);
}

/// The service stops the machine while HAL still catches up: quick stop, then off.
TEST(LostPeriods, AJointThatHalLeadsLateIsOffWhereItStandsHoweverLongHalHadStalled) {
  constexpr int kStopsAfter = 40, kRampsFor = 30;  // periods
  for (const int stalled : {0, 5, 30, 55, 90, 200}) {
    Chain chain;
    for (int n = 0; n < 100; ++n) chain.period(true, false);
    for (int n = 0; n < stalled; ++n) chain.period(true, false, true);
    for (int n = 0; n < kStopsAfter; ++n) chain.period(true, false);
    chain.command(0x02);
    for (int n = 0; n < kRampsFor; ++n) chain.period(true, false);
    chain.command(0x00);
    double velocity = chain.velocity();
    for (int n = 0; n < 300 && chain.has_power_stage_on(); ++n) {
      velocity = chain.velocity();
      chain.period(false, false);
    }
    EXPECT_FALSE(chain.has_power_stage_on()) << stalled;
    EXPECT_LE(velocity, 1.5 * kAcceleration * 1e-3) << "one step of its ramp; stalled " << stalled;
  }
}

/// 5 mm at 150 mm/s are 33 periods.
TEST(LostPeriods, AStallOfHalIsAFollowingErrorWhereTheJointIsFastForIt) {
  for (const int stalled : {28, 36}) {
    Chain chain;
    chain.report_by_hal();
    for (int n = 0; n < 100; ++n) chain.period(true, false);
    for (int n = 0; n < stalled; ++n) chain.period(true, false, true);
    EXPECT_EQ(chain.error(), stalled < 30 ? drive::kErrorNone : drive::kErrorFollowing) << stalled;
    EXPECT_EQ(chain.is_on(), stalled < 30) << "off without a ramp";
    for (int n = 0; n < 80; ++n) chain.period(true, false);
    EXPECT_EQ(chain.has_power_stage_on(), stalled < 30);
  }
}

}  // namespace
}  // namespace meridian::hal
