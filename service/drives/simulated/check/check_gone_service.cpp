// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "meridian/kinematics/limited.hpp"
#include "service/drives/kit/csp/cia402.hpp"
#include "service/drives/simulated/check/drive_check.hpp"

/// The part of DriveCheck in which the service is gone while something moves.
namespace meridian::drives {

namespace {

constexpr int kMotorLag = 8;  // periods by which motors may be behind

}  // namespace

/// From the last setpoint to rest: the bridge, then the ramp.
void DriveCheck::check_stopping_distance(Rule rule, double last, double velocity) {
  const JointLimits& limits = drive_spec(player_.model(), static_cast<int>(mover_)).limits;
  const double distance = direction_ * (player_.newest.position[mover_] - last);
  const double bridge = velocity * CheckPlayer::kBridge * player_.dt_s();
  const double ramp = velocity * velocity / (2 * limits.fault_acceleration);
  const double slack = kMotorLag * velocity * player_.dt_s();
  if (distance < bridge + 0.4 * ramp || distance > bridge + 2 * ramp + slack) {
    player_.find(rule, "it stopped " + std::to_string(distance) +
                           " mm after the last setpoint; bridge " + std::to_string(bridge) +
                           ", ramp " + std::to_string(ramp));
  }
}

/// SIGKILL as drives see it: no word any more, and no goodbye until the lease runs out. Each period
/// is looked at from there to rest. Who lost some may report bridge and ramp at once, and no more.
void DriveCheck::check_killed() {
  if (!walk_up()) return;
  const double velocity = 0.5 * limit_, period = velocity * player_.dt_s();
  speed_up(velocity);
  for (int n = 0; n < 20; ++n) lead(velocity);
  const double last = player_.target[mover_];
  const double ramp_s =
      velocity / drive_spec(player_.model(), static_cast<int>(mover_)).limits.fault_acceleration;
  const double whole_stop = (CheckPlayer::kBridge + kMotorLag) * period + 0.5 * velocity * ramp_s;
  const int promised = CheckPlayer::kBridge + static_cast<int>(2 * ramp_s / player_.dt_s());
  constexpr int kSlack = 60, kWatched = 300;  // periods
  player_.saying = Saying::kNothing;
  int moved_for = 0;
  double farthest = 0, back = 0;
  for (int n = 1; n <= promised + kSlack + kWatched; ++n) {
    const double before = player_.newest.position[mover_];
    player_.tick();
    const double step = direction_ * (player_.newest.position[mover_] - before);
    farthest = std::max(farthest, step);
    back = std::max(back, -step);
    if (std::abs(step) > 0.02 * period) moved_for = n;
  }
  player_.saying = Saying::kAll;
  if (!player_.are_all(DriveState::kFault)) {
    player_.find(Rule::kKilled, std::string("it ends in ") + name_of(player_.state(0)));
  } else if (farthest > whole_stop || back > period) {
    player_.find(Rule::kKilled, "it jumped by " + std::to_string(std::max(farthest, back)) + " mm");
  } else if (moved_for > promised + kSlack) {
    player_.find(Rule::kKilled, "it moved for " + std::to_string(moved_for) + " periods");
  }
  check_stopping_distance(Rule::kKilled, last, velocity);
}

/// The service is gone in the motion, and starts again at once.
void DriveCheck::check_restart() {
  if (!walk_up()) return;
  const double velocity = 0.5 * limit_;
  player_.is_disturbed = false;
  speed_up(velocity);
  const double last = player_.target[mover_];
  player_.end_service();
  player_.tick();
  player_.restart_service();
  player_.say_word(0x06);
  player_.flags = 0;
  player_.stand();
  const auto is_over = [this] {
    return player_.are_all(DriveState::kFault) || player_.are_all(DriveState::kReadyToSwitchOn) ||
           player_.are_all(DriveState::kSwitchOnDisabled);
  };
  const bool ends = player_.until(is_over, CheckPlayer::kPatience);
  if (player_.are_all(DriveState::kReadyToSwitchOn)) {
    return player_.find(Rule::kRestart, "its 06h was obeyed while the drives were on");
  }
  if (!ends || player_.newest.error[mover_] != drive::kErrorSetpointsStopped) {
    player_.find(Rule::kGoneInMotion, !ends ? "it goes on without a service"
                                            : "error " + in_hex(player_.newest.error[mover_]));
  }
  player_.ticks(100);
  if (!player_.is_disturbed) check_stopping_distance(Rule::kGoneInMotion, last, velocity);
  const auto is_obeyed = [this] { return player_.newest.service_id == CheckPlayer::kRestartedId; };
  if (!player_.until(is_obeyed, CheckPlayer::kPatience)) {
    const bool is_kept = player_.newest.service_id == CheckPlayer::kServiceId;
    return player_.find(is_kept ? Rule::kFreesMaster : Rule::kRestart,
                        "service_id " + std::to_string(player_.newest.service_id));
  }
  if (walk_up() && !player_.is_heard()) {
    player_.find(Rule::kRestart, "its setpoints, which count anew, are not taken");
  }
}

}  // namespace meridian::drives
