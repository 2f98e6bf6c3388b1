// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/hal_hardware.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "service/drives/kit/pace.hpp"

namespace meridian::hal {
namespace {

// Source: CiA 402, object 603Fh.
constexpr std::uint16_t kErrorDevice = 0x5000, kErrorCommunication = 0x7500,
                        kErrorSetpointsStopped = 0x8700;
/// HAL's servo thread says nothing for so long, and for the bridge: it does not run.
constexpr std::int64_t kSilent_ns = 50'000'000;
constexpr const char* kHalIsStopped = "HAL is stopped, or its servo thread does not run";

[[nodiscard]] meridian_hal_action action_of(drive::ActionKind kind) noexcept {
  switch (kind) {
    case drive::ActionKind::kSpindleOff:
      return MERIDIAN_HAL_SPINDLE_OFF;
    case drive::ActionKind::kSpindleClockwise:
      return MERIDIAN_HAL_SPINDLE_CLOCKWISE;
    case drive::ActionKind::kSpindleCounterClockwise:
      return MERIDIAN_HAL_SPINDLE_COUNTERCLOCKWISE;
    case drive::ActionKind::kCoolantOff:
      return MERIDIAN_HAL_COOLANT_OFF;
    case drive::ActionKind::kCoolantMist:
      return MERIDIAN_HAL_COOLANT_MIST;
    case drive::ActionKind::kCoolantFlood:
      return MERIDIAN_HAL_COOLANT_FLOOD;
    case drive::ActionKind::kToolChange:
      return MERIDIAN_HAL_TOOL_CHANGE;
    default:
      return MERIDIAN_HAL_NO_ACTION;
  }
}

}  // namespace

HalHardware::HalHardware(meridian_hal_shared& shared, const std::vector<drive::Axis>& axes,
                         std::int64_t period_ns, std::int64_t bridge_ns)
    : shared_(shared), bridge_ns_(bridge_ns), grid_(period_ns) {
  meridian_hal_setup setup{};
  setup.joints = static_cast<std::uint32_t>(axes.size());
  setup.period_ns = period_ns;
  setup.bridge_ns = bridge_ns;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const drive::Axis& axis = axes[i];
    if (axis.is_rotary) setup.rotary_mask |= 1U << i;
    setup.fault_acceleration[i] = axis.fault_acceleration;
    Joint joint;
    joint.homing = axis.homing.method;
    joint.is_referenced = axis.homing.is_referenced;
    joint.farthest_step = 1.5 * axis.velocity * 1e-9 * static_cast<double>(period_ns);
    joints_.push_back(joint);
  }
  __atomic_store_n(&shared_.setup.magic, 0U, __ATOMIC_RELEASE);
  shared_.setup = setup;
  __atomic_store_n(&shared_.setup.magic, MERIDIAN_HAL_MAGIC, __ATOMIC_RELEASE);
  for (const meridian_hal_setpoint& old : shared_.setpoints) {
    setpoint_.number = std::max(setpoint_.number, old.number);
  }
  report_.number = shared_.report.number;  // what stands there may be of a HAL that is gone
  order_over_ = shared_.order.number;
}

void HalHardware::take_report() noexcept {
  const std::uint64_t before = report_.number;
  meridian_hal_report report;
  if (meridian_hal_read(&shared_.report_lock, &shared_.report, &report, sizeof report) == 0) return;
  report_ = report;
  if (report_.number != before) heard_ns_ = drive::monotonic_ns();
  order_result_.store(report_.order_result, std::memory_order_relaxed);
  order_over_.store(report_.order_over, std::memory_order_release);
}

bool HalHardware::hear(std::int64_t now_ns) noexcept {
  take_report();
  is_alive_ = heard_ns_ != 0 && now_ns - heard_ns_ <= kSilent_ns + bridge_ns_;
  may_act_.store(is_alive_ && report_.is_stopped == 0, std::memory_order_relaxed);
  return is_alive_;
}

void HalHardware::write(int axis, const drive::Output& output) noexcept {
  const auto i = static_cast<std::size_t>(axis);
  const std::uint32_t bit = 1U << i;
  Joint& joint = joints_[i];
  const auto set = [bit](std::uint32_t& mask, bool is_set) {
    mask = is_set ? mask | bit : mask & ~bit;
  };
  joint.is_on = output.is_on;
  elapsed_s_ = output.elapsed_s;
  setpoint_.position[i] = output.position + joint.hidden;
  setpoint_.velocity[i] = output.is_on ? output.velocity : 0;
  set(setpoint_.on_mask, output.is_on);
  set(setpoint_.homing_mask, output.is_homing);
  set(setpoint_.reset_mask, output.is_reset);
  // After a pulse it is asked for anew: one period without it.
  const bool is_pulse = joint.index_count != report_.index_count[i];
  set(setpoint_.index_mask, joint.homing == drive::HomingMethod::kByIndex && output.is_on &&
                                !joint.is_referenced && !is_pulse);
  if (!output.is_homing) joint.homed_pin = HomedPin::kOfBefore;
}

void HalHardware::exchange(double dt_s) noexcept {
  const std::int64_t now_ns = drive::monotonic_ns();
  setpoint_.end_ns = grid_.end_of(now_ns, setpoint_.on_mask != 0 ? elapsed_s_ : dt_s);
  ++setpoint_.number;
  meridian_hal_write(&shared_.setpoint_lock,
                     &shared_.setpoints[setpoint_.number % MERIDIAN_HAL_KEPT], &setpoint_,
                     sizeof setpoint_);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].index_count = report_.index_count[i];
  }
  (void)hear(now_ns);
}

drive::Reading HalHardware::read(int axis) noexcept {
  const auto i = static_cast<std::size_t>(axis);
  const std::uint32_t bit = 1U << i;
  Joint& joint = joints_[i];
  const double before = joint.position;
  joint.position = report_.position[i];
  if ((setpoint_.homing_mask & bit) != 0) {
    const bool is_homed = (report_.homed_mask & bit) != 0;
    const double step = joint.position - before;
    joint.homed_pin = !is_homed                           ? HomedPin::kLow
                      : joint.homed_pin == HomedPin::kLow ? HomedPin::kRisen
                                                          : HomedPin::kOfBefore;
    const bool is_jump = joint.farthest_step > 0 && std::abs(step) > joint.farthest_step;
    if (is_jump || joint.homed_pin == HomedPin::kRisen) joint.hidden += step;
  }
  drive::Reading reading;
  reading.position = joint.position - joint.hidden;
  reading.is_index = joint.index_count != report_.index_count[i];
  reading.index_position = report_.index_position[i] - joint.hidden;
  reading.has_power = report_.is_lost == 0 && report_.is_stopped == 0;
  if ((report_.fault_mask & bit) != 0) reading.error = kErrorDevice;
  if (report_.is_lost != 0 && joint.is_on) reading.error = kErrorSetpointsStopped;
  if (!is_alive_) reading.error = kErrorCommunication;
  return reading;
}

drive::Probe HalHardware::probe() noexcept {
  const auto probe = static_cast<drive::Probe>(report_.probe);
  return probe <= drive::Probe::kContact ? probe : drive::Probe::kNone;
}

drive::HomingStep HalHardware::home(int axis, const drive::HomingView& view) noexcept {
  Joint& joint = joints_[static_cast<std::size_t>(axis)];
  drive::HomingStep step{drive::HomingState::kSearching, view.position, 0, 0};
  if (view.is_begin || joint.homed_pin != HomedPin::kRisen) return step;
  joint.homed_pin = HomedPin::kOfBefore;
  step.state = drive::HomingState::kAttained;
  step.shift = joint.hidden;
  joint.hidden = 0;
  return step;
}

void HalHardware::set_referenced(int axis, bool is_referenced) noexcept {
  joints_[static_cast<std::size_t>(axis)].is_referenced = is_referenced;
}

std::string HalHardware::act(const drive::Action& action, const std::atomic<bool>& is_stopping) {
  if (action.kind == drive::ActionKind::kStop) return "";
  const meridian_hal_action kind = action_of(action.kind);
  if (kind == MERIDIAN_HAL_NO_ACTION) return "HAL has no pin for " + action.words;
  if (!may_act_.load(std::memory_order_relaxed)) return kHalIsStopped;
  const std::uint64_t number = give_order(kind, action.value);
  while (order_over_.load(std::memory_order_acquire) != number) {
    const bool may_act = may_act_.load(std::memory_order_relaxed);
    if (is_stopping || !may_act) {
      // A HAL that comes back later must not run what was reported as failed.
      (void)give_order(MERIDIAN_HAL_NO_ACTION, 0);
      return is_stopping ? "meridian-hal ends" : kHalIsStopped;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const bool is_done = order_result_.load(std::memory_order_relaxed) == MERIDIAN_HAL_ORDER_DONE;
  return is_done ? "" : kHalIsStopped;
}

std::uint64_t HalHardware::give_order(meridian_hal_action action, double value) noexcept {
  meridian_hal_order order{};
  order.number = shared_.order.number + 1;
  order.action = action;
  order.value = value;
  meridian_hal_write(&shared_.order_lock, &shared_.order, &order, sizeof order);
  return order.number;
}

}  // namespace meridian::hal
