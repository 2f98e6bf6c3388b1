// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/limited.hpp"
#include "service/drives/kit/csp/cia402.hpp"
#include "service/drives/simulated/check/drive_check.hpp"

/// The part of DriveCheck in which something moves, or is sent that is not to move anything.
namespace meridian::drives {

void DriveCheck::lead(double velocity) {
  player_.target[mover_] += direction_ * velocity * player_.dt_s();
  player_.velocity[mover_] = direction_ * velocity;
  player_.tick();
}

void DriveCheck::speed_up(double to) {
  constexpr int kPeriods = 100;
  const double from = std::abs(player_.velocity[mover_]);
  for (int n = 1; n <= kPeriods; ++n) lead(from + (to - from) * n / kPeriods);
}

void DriveCheck::check_following() {
  if (!walk_up()) return;
  const double tolerance =
      drive_spec(player_.model(), static_cast<int>(mover_)).limits.following_error;
  const double begin = player_.newest.position[mover_];
  speed_up(0.2 * limit_);
  for (int n = 0; n < 50; ++n) lead(0.2 * limit_);
  speed_up(0);
  player_.ticks(200);
  const double distance = player_.target[mover_] - begin,
               off = player_.target[mover_] - player_.newest.position[mover_];
  if (std::abs(off) > std::min(tolerance, 0.1 * std::abs(distance)) ||
      !player_.are_all(DriveState::kOperationEnabled)) {
    player_.find(Rule::kFollows,
                 "it is " + std::to_string(off) + " mm off after " + std::to_string(distance));
  }
}

void DriveCheck::check_dropped(Rule rule, Speaker who, const Spoil& spoil, bool counts_cycle) {
  if (!walk_up()) return;
  const double step = 0.5 * limit_ * player_.dt_s();
  const double stood = player_.newest.position[mover_];
  double moved = 0;
  player_.has_seen_odd = false;
  for (int n = 0; n < 40; ++n) {
    player_.tick([&](CheckedDrives& drives) {
      dds::SetpointSample sample = player_.odd_setpoint();
      sample.setpoint.position[mover_] += step;
      CheckPlayer::sign(sample);
      spoil(sample);
      drives.say(who, sample);
    });
    moved = std::max(moved, std::abs(player_.newest.position[mover_] - stood));
  }
  player_.ticks(5);
  if (!player_.are_all(DriveState::kOperationEnabled)) {
    player_.find(rule, "the drives left operation");
  } else if (player_.has_seen_odd && counts_cycle) {
    player_.find(rule, "it was taken: cycle_seen");
  } else if (moved > 0.4 * step) {
    player_.find(rule, "the drive moved by " + std::to_string(moved) + " mm");
  }
}

void DriveCheck::check_all_dropped() {
  const auto dropped = [this](const char* what, Rule rule, Speaker who, const Spoil& spoil,
                              bool counts_cycle = true) {
    step(what, [&] { check_dropped(rule, who, spoil, counts_cycle); });
  };
  dropped(
      "setpoints without the flag 1", Rule::kNotEnabledSetpoint, Speaker::kService,
      [](auto& sample) { sample.setpoint.flags = 0, CheckPlayer::sign(sample); }, false);
  dropped("old setpoints", Rule::kOrder, Speaker::kService,
          [](auto& sample) { sample.setpoint.cycle -= 50, CheckPlayer::sign(sample); });
  dropped("wrong checksums", Rule::kChecksum, Speaker::kService,
          [](auto& sample) { sample.crc ^= 1U; });
  dropped("late setpoints", Rule::kLate, Speaker::kService, [](auto& sample) {
    sample.setpoint.due_ns -= 1'000'000'000;
    CheckPlayer::sign(sample);
  });
  dropped("dry run", Rule::kDryRun, Speaker::kService, [](auto& sample) {
    sample.setpoint.flags = kSetpointDry | kSetpointEnabled;
    CheckPlayer::sign(sample);
  });
  dropped("others' setpoints", Rule::kForeignSetpoint, Speaker::kOther, [](auto&) {});
}

void DriveCheck::check_doubled() {
  if (!walk_up()) return;
  const double velocity = 0.2 * limit_;
  player_.saying = Saying::kSetpointsTwice;
  speed_up(velocity);
  for (int n = 0; n < 50; ++n) lead(velocity);
  speed_up(0);
  player_.ticks(200);
  const double off = std::abs(player_.target[mover_] - player_.newest.position[mover_]);
  const double far = 0.1 * velocity * 150 * player_.dt_s();  // of the whole motion
  if (off > far || !player_.are_all(DriveState::kOperationEnabled)) {
    return player_.find(Rule::kDoubled, "each sent twice, it is " + std::to_string(off) +
                                            " mm off, in " + name_of(player_.state(0)));
  }
  player_.saying = Saying::kLastSetpointAgain;
  const bool ends = player_.until([this] { return player_.are_all(DriveState::kFault); }, 1000);
  player_.saying = Saying::kAll;
  if (!ends) player_.find(Rule::kDoubled, "the last one, sent again and again, keeps it on");
}

void DriveCheck::check_bridge() {
  if (!walk_up()) return;
  constexpr int kGap = CheckPlayer::kBridge - 8;
  const double velocity = 0.2 * limit_;
  speed_up(velocity);
  for (int n = 0; n < 50; ++n) lead(velocity);
  const double begin = player_.newest.position[mover_];
  player_.saying = Saying::kNoSetpoints;
  for (int n = 0; n < kGap; ++n) lead(velocity);
  player_.saying = Saying::kAll;
  const double distance = std::abs(player_.newest.position[mover_] - begin);
  for (int n = 0; n < 20; ++n) lead(velocity);
  speed_up(0);
  if (!player_.are_all(DriveState::kOperationEnabled)) {
    player_.find(Rule::kBridge, "the drives left operation after " + std::to_string(kGap) +
                                    " lost setpoints of " + std::to_string(CheckPlayer::kBridge));
  } else if (distance < 0.6 * velocity * kGap * player_.dt_s()) {
    player_.find(Rule::kBridge, "the drive stopped while setpoints were lost");
  }
}

void DriveCheck::check_watchdog() {
  if (!walk_up()) return;
  const double velocity = 0.5 * limit_;
  speed_up(velocity);
  for (int n = 0; n < 20; ++n) lead(velocity);
  const double last = player_.target[mover_];
  player_.saying = Saying::kNoSetpoints;
  const auto is_fault = [this] { return player_.are_all(DriveState::kFault); };
  const bool ends = player_.until(is_fault, CheckPlayer::kPatience);
  player_.ticks(100);
  player_.saying = Saying::kAll;
  if (!ends) return player_.find(Rule::kWatchdog, "it goes on without setpoints");
  if (player_.newest.error[mover_] != drive::kErrorSetpointsStopped) {
    player_.find(Rule::kWatchdog, "error " + in_hex(player_.newest.error[mover_]));
  }
  check_stopping_distance(Rule::kRamp, last, velocity);
}

void DriveCheck::check_refused(Rule rule, std::uint16_t error, const Spoil& spoil) {
  if (!walk_up()) return;
  const double stood = player_.newest.position[mover_];
  player_.saying = Saying::kNoSetpoints;  // a good one that comes in the same period would hide it
  player_.ticks(3, [&](CheckedDrives& drives) {
    dds::SetpointSample sample = player_.odd_setpoint();
    spoil(sample);
    CheckPlayer::sign(sample);
    drives.say(Speaker::kService, sample);
  });
  player_.saying = Saying::kAll;
  const auto is_refused = [this] {
    const DriveState state = player_.state(static_cast<int>(mover_));
    return state == DriveState::kFault || state == DriveState::kFaultReaction;
  };
  const bool refuses = player_.until(is_refused, 60);
  player_.ticks(60);
  const double moved = std::abs(player_.newest.position[mover_] - stood);
  if (!refuses || player_.newest.error[mover_] != error) {
    player_.find(rule, refuses ? "error " + in_hex(player_.newest.error[mover_]) : "it was taken");
  } else if (moved > 2 * limit_ * player_.dt_s()) {
    player_.find(rule, "it moved by " + std::to_string(moved) + " mm");
  }
}

void DriveCheck::check_all_refused() {
  const JointSpec& spec = drive_spec(player_.model(), static_cast<int>(mover_));
  const auto refused = [this](const char* what, Rule rule, std::uint16_t error,
                              const Spoil& spoil) {
    step(what, [&] { check_refused(rule, error, spoil); });
  };
  refused("no number", Rule::kNoNumber, drive::kErrorSetpointNoNumber, [&](auto& sample) {
    sample.setpoint.position[mover_] = std::numeric_limits<double>::quiet_NaN();
  });
  const bool has_travel = !spec.is_endless && spec.limits.travel_min < spec.limits.travel_max;
  if (has_travel && (player_.newest.referenced_mask >> mover_ & 1U) != 0) {
    refused("travel", Rule::kTravel, drive::kErrorSetpointTravel,
            [&](auto& sample) { sample.setpoint.position[mover_] = spec.limits.travel_max + 100; });
  }
  refused("velocity", Rule::kVelocity, drive::kErrorSetpointVelocity,
          [&](auto& sample) { sample.setpoint.velocity[mover_] = 1.5 * limit_; });
  refused("step", Rule::kStep, drive::kErrorSetpointStep, [&](auto& sample) {
    sample.setpoint.position[mover_] += direction_ * 40 * limit_ * player_.dt_s();
  });
}

void DriveCheck::check_begin() {
  if (!walk_up()) return;
  const double apart =
      0.9 * drive_spec(player_.model(), static_cast<int>(mover_)).limits.following_error;
  if (apart == 0) return;
  player_.flags = 0;
  player_.ticks(30);
  player_.stand();
  player_.target[mover_] += direction_ * apart;
  player_.flags = kSetpointEnabled;
  player_.ticks(60);
  if (player_.newest.error[mover_] != drive::kErrorSetpointBegin) {
    player_.find(Rule::kBegin, "error " + in_hex(player_.newest.error[mover_]));
  }
}

}  // namespace meridian::drives
