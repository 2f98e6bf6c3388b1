// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/hal_hardware.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <climits>
#include <thread>

#include "service/drives/hal/hal_memory.hpp"

namespace meridian::hal {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

[[nodiscard]] std::int64_t monotonic_ns() {
  timespec now{};
  (void)::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

[[nodiscard]] std::vector<drive::Axis> axes() {
  std::vector<drive::Axis> out(2);
  out[0].name = "X";
  out[0].velocity = 300;
  out[0].fault_acceleration = 5000;
  out[0].homing = {.method = drive::HomingMethod::kByDrive, .is_referenced = false};
  out[1].name = "C";
  out[1].is_rotary = true;
  out[1].homing = {
      .method = drive::HomingMethod::kByIndex, .is_referenced = false, .search_velocity = 1};
  return out;
}

/// The component's side is played by the test.
class HalSide : public testing::Test {
 protected:
  void report() {
    ++report_.number;
    meridian_hal_write(&shared_.report_lock, &shared_.report, &report_, sizeof report_);
  }
  void period(const drive::Output& output) {
    report();
    hardware_.write(0, output);
    hardware_.write(1, output);
    hardware_.exchange(1e-3);
    reading_ = hardware_.read(0);
    other_ = hardware_.read(1);
  }
  [[nodiscard]] const meridian_hal_setpoint& newest() const {
    const meridian_hal_setpoint* out = &shared_.setpoints[0];
    for (const meridian_hal_setpoint& one : shared_.setpoints) {
      if (one.number > out->number) out = &one;
    }
    return *out;
  }

  meridian_hal_shared shared_{};
  meridian_hal_report report_{};
  HalHardware hardware_{shared_, axes(), kPeriod_ns, 3 * kPeriod_ns};
  drive::Reading reading_, other_;
};

TEST_F(HalSide, SetUpAndSetpointsAreWhatTheComponentReads) {
  EXPECT_EQ(shared_.setup.magic, MERIDIAN_HAL_MAGIC);
  EXPECT_EQ(shared_.setup.joints, 2U);
  EXPECT_EQ(shared_.setup.rotary_mask, 0b10U);
  EXPECT_EQ(shared_.setup.fault_acceleration[0], 5000);
  report_.position[0] = 4;
  period({.is_on = true, .position = 4.5, .velocity = 10});
  EXPECT_EQ(newest().number, 1U);
  EXPECT_EQ(newest().position[0], 4.5);
  EXPECT_EQ(newest().on_mask, 0b11U);
  EXPECT_NEAR(static_cast<double>(newest().end_ns - monotonic_ns()), 0, 5e9) << "of this clock";
  EXPECT_EQ(reading_.position, 4);
  EXPECT_EQ(reading_.error, 0);
}

TEST_F(HalSide, AnotherProcessGoesOnBehindTheSetpointsThatAreThere) {
  for (int n = 0; n < 20; ++n) period({});
  HalHardware next(shared_, axes(), kPeriod_ns, 3 * kPeriod_ns);
  next.exchange(1e-3);
  EXPECT_EQ(newest().number, 21U);
}

TEST_F(HalSide, HalThatSaysNothingIsAFault) {
  period({});
  EXPECT_EQ(reading_.error, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  hardware_.exchange(1e-3);
  EXPECT_EQ(hardware_.read(0).error, 0x7500);
}

TEST_F(HalSide, ATouchProbeIsReported) {
  period({.is_on = true});
  EXPECT_EQ(hardware_.probe(), drive::Probe::kNone);
  report_.probe = 1;
  period({.is_on = true});
  EXPECT_EQ(hardware_.probe(), drive::Probe::kFree);
  report_.probe = 2;
  period({.is_on = true});
  EXPECT_EQ(hardware_.probe(), drive::Probe::kContact);
}

TEST_F(HalSide, AnOpenGuardIsReported) {
  period({.is_on = true});
  EXPECT_FALSE(hardware_.is_guard_open());
  report_.is_guard_open = 1;
  period({.is_on = true});
  EXPECT_TRUE(hardware_.is_guard_open());
}

TEST_F(HalSide, FaultStopAndLostSetpointsAreReported) {
  report_.fault_mask = 0b01;
  period({.is_on = true});
  EXPECT_EQ(reading_.error, 0x5000);
  EXPECT_EQ(other_.error, 0);
  report_.fault_mask = 0;
  report_.is_stopped = 1;
  period({.is_on = true});
  EXPECT_TRUE(hardware_.is_emergency_stop());
  EXPECT_FALSE(reading_.has_power);
  report_.is_stopped = 0;
  report_.is_lost = 1;
  period({.is_on = true});
  EXPECT_EQ(reading_.error, 0x8700);
  period({});
  EXPECT_EQ(reading_.error, 0) << "off: it only has no power";
  EXPECT_FALSE(reading_.has_power);
}

TEST_F(HalSide, AReferenceThatHalFoundRenamesWithoutAJump) {
  report_.homed_mask = 0b01;  // of a search before
  period({.is_on = true});
  (void)hardware_.home(0, {.is_begin = true});
  for (int n = 0; n < 3; ++n) period({.is_on = true, .is_homing = true});
  EXPECT_EQ(newest().homing_mask, 0b11U);
  EXPECT_EQ(hardware_.home(0, {}).state, drive::HomingState::kSearching);
  report_.homed_mask = 0;
  report_.position[0] = -0.2;
  period({.is_on = true, .is_homing = true});
  EXPECT_DOUBLE_EQ(reading_.position, -0.2);
  report_.position[0] = 99.9;  // renamed, then homed
  period({.is_on = true, .is_homing = true});
  EXPECT_NEAR(reading_.position, -0.2, 1e-9);
  report_.homed_mask = 0b01;
  report_.position[0] = 100;
  period({.is_on = true, .is_homing = true});
  EXPECT_NEAR(reading_.position, -0.2, 1e-9);
  const drive::HomingStep step = hardware_.home(0, {});
  EXPECT_EQ(step.state, drive::HomingState::kAttained);
  EXPECT_NEAR(step.shift, 100.2, 1e-9);
  period({.is_on = true, .position = 100});
  EXPECT_DOUBLE_EQ(reading_.position, 100);
  EXPECT_DOUBLE_EQ(newest().position[0], 100);
}

TEST_F(HalSide, AnIndexPulseIsOnePeriodLongAndIsAskedForAnew) {
  period({.is_on = true});
  EXPECT_EQ(newest().index_mask, 0b10U) << "C alone goes to the index";
  report_.index_count[1] = 1;
  report_.index_position[1] = 0.7;
  period({.is_on = true});
  EXPECT_TRUE(other_.is_index);
  EXPECT_EQ(other_.index_position, 0.7);
  period({.is_on = true});
  EXPECT_FALSE(other_.is_index);
  EXPECT_EQ(newest().index_mask, 0U);
  period({.is_on = true});
  EXPECT_EQ(newest().index_mask, 0b10U);
  hardware_.set_referenced(1, true);
  period({.is_on = true});
  EXPECT_EQ(newest().index_mask, 0U);
}

TEST_F(HalSide, ActionsWaitUntilHalHasDoneThem) {
  period({});
  std::atomic<bool> is_stopping{false}, is_over{false};
  std::thread hal([&] {
    while (!is_over) {
      report_.order_over = shared_.order.number;
      report_.order_result = MERIDIAN_HAL_ORDER_DONE;
      report();
      (void)hardware_.hear(monotonic_ns());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  const drive::Action spindle{
      .kind = drive::ActionKind::kSpindleClockwise, .value = 8000, .text = "", .words = "spindle"};
  EXPECT_EQ(hardware_.act(spindle, is_stopping), "");
  EXPECT_EQ(shared_.order.action, static_cast<std::uint32_t>(MERIDIAN_HAL_SPINDLE_CLOCKWISE));
  EXPECT_EQ(shared_.order.value, 8000);
  is_over = true;
  hal.join();
  const drive::Action word{.kind = drive::ActionKind::kVendorWord, .text = "M88", .words = "M88"};
  EXPECT_EQ(hardware_.act(word, is_stopping), "HAL has no pin for M88");
}

/// HAL's side in a thread: reports until the end, with orders over as `result` says; 0: they never
/// are. It opens the chain behind `stop_after` reports.
class HalThatReports {
 public:
  HalThatReports(meridian_hal_shared& shared, HalHardware& hardware, std::uint32_t result,
                 int stop_after = INT_MAX)
      : thread_([=, &shared, &hardware](const std::stop_token& end) {
          meridian_hal_report report{};
          report.number = 1000;
          for (int n = 0; !end.stop_requested(); ++n) {
            ++report.number;
            report.order_result = result;
            if (result != 0) report.order_over = shared.order.number;
            report.is_stopped = n > stop_after ? 1 : 0;
            meridian_hal_write(&shared.report_lock, &shared.report, &report, sizeof report);
            (void)hardware.hear(monotonic_ns());
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}

 private:
  std::jthread thread_;
};

const drive::Action kSpindle{
    .kind = drive::ActionKind::kSpindleClockwise, .value = 8000, .text = "", .words = "spindle"};
constexpr const char* kStopped = "HAL is stopped, or its servo thread does not run";

TEST_F(HalSide, AnOrderThatHalStoppedHasFailed) {
  period({});
  const std::atomic<bool> is_stopping{false};
  const HalThatReports hal(shared_, hardware_, MERIDIAN_HAL_ORDER_FAILED);
  EXPECT_EQ(hardware_.act(kSpindle, is_stopping), kStopped);
}

TEST_F(HalSide, AnOrderThatIsGivenUpIsTakenBack) {
  period({});
  const std::atomic<bool> is_stopping{false};
  const HalThatReports hal(shared_, hardware_, 0, 20);
  EXPECT_EQ(hardware_.act(kSpindle, is_stopping), kStopped);
  EXPECT_EQ(shared_.order.action, static_cast<std::uint32_t>(MERIDIAN_HAL_NO_ACTION));
  EXPECT_EQ(shared_.order.number, 2U);
}

TEST_F(HalSide, NoOrderIsWrittenForAHalThatDoesNotRun) {
  const std::atomic<bool> is_stopping{false};
  EXPECT_EQ(hardware_.act(kSpindle, is_stopping), kStopped);
  EXPECT_EQ(shared_.order.number, 0U);
}

TEST_F(HalSide, AReportOfAHalThatIsGoneIsNoSignOfLife) {
  report();
  HalHardware next(shared_, axes(), kPeriod_ns, 3 * kPeriod_ns);
  EXPECT_FALSE(next.hear(monotonic_ns()));
  report();
  EXPECT_TRUE(next.hear(monotonic_ns()));
}

TEST(HalMemory, BothSidesSeeTheSame) {
  const std::string name = "test-" + std::to_string(::getpid());
  {
    const HalMemory one(name), other(name);
    one.get().order.number = 5;
    EXPECT_EQ(other.get().order.number, 5U);
  }
  EXPECT_EQ(std::remove(("/dev/shm" MERIDIAN_HAL_FILE + name).c_str()), 0);
}

}  // namespace
}  // namespace meridian::hal
