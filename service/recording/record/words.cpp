// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/words.hpp"

#include <array>
#include <cstddef>
#include <limits>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/drive_state.hpp"

namespace meridian::record {
namespace {

using namespace std::string_view_literals;

constexpr auto kKinds =
    std::to_array({"approach"sv, "cut"sv, "rapid"sv, "pole_turn"sv, "unwind"sv});
static_assert(kKinds.size() == static_cast<std::size_t>(MotionKind::kRewind) + 1);

constexpr auto kStates =
    std::to_array({"off"sv, "enabling"sv, "ready"sv, "loaded"sv, "approaching"sv, "running"sv,
                   "holding"sv, "held"sv, "starving"sv, "starved"sv, "aborting"sv, "disabling"sv,
                   "fault_stop"sv, "fault"sv, "jogging"sv, "homing"sv, "stepping"sv});
static_assert(kStates.size() == kStateCount);

constexpr auto kAlarms = std::to_array({"none"sv,
                                        "not_finite"sv,
                                        "travel"sv,
                                        "step"sv,
                                        "unreachable"sv,
                                        "drive_fault"sv,
                                        "feedback_lost"sv,
                                        "following_error"sv,
                                        "emergency_stop"sv,
                                        "periods_lost"sv,
                                        "enable_timeout"sv,
                                        "action_failed"sv,
                                        "homing_failed"sv,
                                        "homing_timeout"sv,
                                        "reference_lost"sv,
                                        "drive_enabled"sv,
                                        "setpoints_unheard"sv,
                                        "drives_astray"sv,
                                        "keep_out"sv,
                                        "tip_box"sv,
                                        "no_contact"sv,
                                        "contact"sv,
                                        "probe_lost"sv,
                                        "standstill"sv,
                                        "joint_speed"sv,
                                        "tip_speed"sv,
                                        "position_window"sv,
                                        "drive_model"sv,
                                        "feedback_jump"sv,
                                        "feedback_frozen"sv,
                                        "feedback_too_fast"sv});
static_assert(kAlarms.size() == static_cast<std::size_t>(Alarm::kFeedbackTooFast) + 1);
static_assert(kAlarms.size() <= std::numeric_limits<decltype(CycleState::alarms_reported)>::digits,
              "CycleState::alarms_reported has a bit for each alarm");

template <class Enum, std::size_t N>
[[nodiscard]] std::optional<Enum> find(const std::array<std::string_view, N>& words,
                                       std::string_view wanted) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    if (words[i] == wanted) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

template <class Enum, std::size_t N>
[[nodiscard]] std::string_view at(const std::array<std::string_view, N>& words,
                                  Enum value) noexcept {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? words[i] : std::string_view("unknown");
}

}  // namespace

std::string_view word(MotionKind kind) noexcept { return at(kKinds, kind); }
std::string_view word(State state) noexcept { return at(kStates, state); }
std::string_view word(Alarm alarm) noexcept { return at(kAlarms, alarm); }

bool is_of_joint(Alarm alarm) noexcept {
  switch (alarm) {
    case Alarm::kNotFinite:
    case Alarm::kTravel:
    case Alarm::kStep:
    case Alarm::kDriveFault:
    case Alarm::kFeedbackLost:
    case Alarm::kFollowingError:
    case Alarm::kEnableTimeout:
    case Alarm::kHomingFailed:
    case Alarm::kHomingTimeout:
    case Alarm::kReferenceLost:
    case Alarm::kDriveEnabled:
    case Alarm::kSetpointsUnheard:
    case Alarm::kDrivesAstray:
    case Alarm::kStandstill:
    case Alarm::kJointSpeed:
    case Alarm::kPositionWindow:
    case Alarm::kDriveModel:
    case Alarm::kFeedbackJump:
    case Alarm::kFeedbackFrozen:
    case Alarm::kFeedbackTooFast:
      return true;
    default:
      return false;
  }
}

std::string_view drive_state_word(std::uint16_t statusword) noexcept {
  return statusword == 0 ? "silent" : name_of(drive_state(statusword));
}

std::optional<MotionKind> find_motion_kind(std::string_view wanted) noexcept {
  return find<MotionKind>(kKinds, wanted);
}
std::optional<State> find_state(std::string_view wanted) noexcept {
  return find<State>(kStates, wanted);
}
std::optional<Alarm> find_alarm(std::string_view wanted) noexcept {
  return find<Alarm>(kAlarms, wanted);
}

std::string position_column(const JointSpec& joint) {
  return joint.name + (joint.is_rotary ? "_rad" : "_mm");
}
std::string velocity_column(const JointSpec& joint) { return position_column(joint) + "_per_s"; }
std::string feedback_column(const JointSpec& drive) {
  return drive.name + (drive.is_rotary ? "_feedback_rad" : "_feedback_mm");
}
std::string statusword_column(const JointSpec& drive) { return drive.name + "_statusword"; }
std::string drive_error_column(const JointSpec& drive) { return drive.name + "_error"; }

}  // namespace meridian::record
