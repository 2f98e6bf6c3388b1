// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/fault_check.hpp"

#include <algorithm>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::soak {
namespace {

/// What is seen here of the time that drives were enabled comes by way of the status.
constexpr double kSeenLate_s = 0.5;
/// The state may be reported before the alarm that led there.
constexpr double kAlarmLate_s = 1;
/// A processor that was away for so long a moment ago makes peers fall silent and drives lag: half
/// of what a service waits for feedback by default.
constexpr double kTooLongAway_s = 0.05;

/// What is seen at least of a stall that drives do not bridge: it may begin within a nap.
[[nodiscard]] double seen_of(double bridge_s) noexcept {
  const auto nap_ns = HostWatch::nap_ns(static_cast<std::int64_t>(bridge_s * 1e9));
  return std::max(bridge_s - static_cast<double>(nap_ns) * 1e-9, 1e-3);
}

/// How long a processor must have been away to make `alarm` where drives bridge `bridge_s`;
/// nothing: no stall makes it.
[[nodiscard]] std::optional<double> away_for(Alarm alarm, bool misses_setpoints,
                                             double bridge_s) noexcept {
  const bool is_of_silence = alarm == Alarm::kFeedbackLost || alarm == Alarm::kFollowingError ||
                             alarm == Alarm::kSetpointsUnheard;
  if (is_of_silence) return kTooLongAway_s;
  const bool is_of_bridge =
      alarm == Alarm::kPeriodsLost || (alarm == Alarm::kDriveFault && misses_setpoints);
  return is_of_bridge ? std::optional(seen_of(bridge_s)) : std::nullopt;
}

}  // namespace

bool explains(const Planned& injected, double enabled_s, Alarm alarm, int joint) noexcept {
  if (enabled_s + kSeenLate_s < injected.at_s) return false;
  switch (injected.mishap) {
    case Mishap::kDriveFault:
      return alarm == Alarm::kDriveFault && joint == injected.drive;
    case Mishap::kDriveBlocked:  // who sees it first says so: the service, or the drive itself
      return alarm == Alarm::kFollowingError ||
             (alarm == Alarm::kDriveFault && joint == injected.drive);
    case Mishap::kDrivesSilent:
      return alarm == Alarm::kFeedbackLost;
    case Mishap::kEmergencyStop:
      return alarm == Alarm::kEmergencyStop;
    default:
      return false;  // what operators and stations do faults no machine
  }
}

void FaultCheck::begin_drives(const std::optional<Planned>& injected) noexcept {
  is_own_doing_ = is_on_;
  injected_ = injected;
  enabled_s_ = 0;
}

void FaultCheck::lose_drives() noexcept { begin_drives(std::nullopt); }

void FaultCheck::lose_service() noexcept {
  is_on_ = is_faulty_ = is_checked_ = is_own_doing_ = false;
  alarm_ = Alarm::kNone;
}

std::optional<FaultCheck::Cause> FaultCheck::see(const dds::Status& status, double now_s,
                                                 const Witness& witness) noexcept {
  if (is_on_) enabled_s_ += now_s - seen_s_;
  is_on_ = is_enabled(status.state);
  seen_s_ = now_s;
  if (!is_fault(status.state)) {
    is_faulty_ = is_checked_ = false;
    alarm_ = Alarm::kNone;
    stop_ns_.reset();
    away_s_ = 0;
    misses_setpoints_ = false;
    return std::nullopt;
  }
  if (!stop_ns_) stop_ns_ = status.time_ns;
  listen(witness);
  if (alarm_ == Alarm::kNone) {
    alarm_ = status.alarm;
    joint_ = status.alarm_joint;
  }
  if (status.state != State::kFault) return std::nullopt;
  if (!std::exchange(is_faulty_, true)) fault_s_ = now_s;
  const bool is_reported = alarm_ != Alarm::kNone || now_s - fault_s_ > kAlarmLate_s;
  if (!is_reported || std::exchange(is_checked_, true)) return std::nullopt;
  if (std::exchange(is_own_doing_, false)) return Cause::kOwnDoing;
  const bool is_injected = injected_ && explains(*injected_, enabled_s_, alarm_, joint_);
  if (is_injected) return Cause::kInjected;
  const auto min_s = away_for(alarm_, misses_setpoints_, bridge_s_);
  if (!min_s) return Cause::kUnprovoked;
  if (!is_watched_) return Cause::kUnwatched;
  return away_s_ >= *min_s ? Cause::kHost : Cause::kUnprovoked;
}

/// A stall is reported when it is over, which may be after the alarm that it caused.
void FaultCheck::listen(const Witness& witness) noexcept {
  const std::int64_t away_ns = longest_away_ns(witness.stalls, *stop_ns_ - kStallsOf_ns, *stop_ns_);
  away_s_ = std::max(away_s_, static_cast<double>(away_ns) * 1e-9);
  is_watched_ = witness.is_watched;
  misses_setpoints_ |= witness.misses_setpoints;
}

std::string FaultCheck::describe() const {
  std::string out = "alarm: " + std::string(record::word(alarm_));
  if (record::is_of_joint(alarm_)) text::append(out, " of joint %d", joint_);
  text::append(out, ", %.1f s after enabling", enabled_s_);
  if (away_s_ > 0) text::append(out, ", a processor away for %.0f ms", 1e3 * away_s_);
  if (injected_) {
    text::append(out, "; planned: %s", word(injected_->mishap));
    if (is_of_drive(injected_->mishap)) text::append(out, " of joint %d", injected_->drive);
    text::append(out, " at %.1f s", injected_->at_s);
  }
  return out;
}

}  // namespace meridian::soak
