// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/jog_hand.hpp"

#include <cmath>
#include <thread>

namespace meridian::stream {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenSamples{20};
constexpr std::chrono::seconds kBraking{5};  ///< no joint takes longer to come to rest
constexpr double kSamePosition = 1e-6;       ///< mm or rad
/// A machine says where it is twenty times a second; one that is silent for so long is gone.
constexpr std::chrono::seconds kSilence{2};
/// What the machine says so long after its reply is no older than that.
constexpr std::chrono::milliseconds kStartDelay{300};

[[nodiscard]] JointVector joints_of(const OperatorLink& link) {
  return link.status() ? link.status()->joints : JointVector{};
}
[[nodiscard]] double position_of(const OperatorLink& link, const JogPlan& plan) {
  return plan.is_tool ? 0 : joints_of(link)[static_cast<std::size_t>(plan.joint)];
}

}  // namespace

JogResult JogHand::jog(const JogPlan& plan, const std::atomic<bool>& is_let_go,
                       std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  while (jogs_.matched_readers() == 0 && Clock::now() < end) {
    (void)link_.wait_for_status(kBetweenSamples);
  }
  const auto reply =
      link_.ask(Verb::kJog, plan.joint + (plan.is_tool ? kMaxJoints : 0), timeout, plan.seen);
  if (!reply || jogs_.matched_readers() == 0) return {JogEnd::kNoAnswer};
  if (!reply->is_accepted) return {JogEnd::kRefused, reply->text};
  const JointVector from = joints_of(link_);
  const Grip grip = hold(plan, *reply, is_let_go);
  if (grip == Grip::kLost) return {JogEnd::kNoAnswer};
  JogResult result = wait_for_rest(plan, grip == Grip::kKept);
  result.has_moved = joints_of(link_) != from;
  return result;
}

void JogHand::send(const JogPlan& plan, std::uint16_t epoch, double velocity) {
  (void)jogs_.write({.operator_id = link_.operator_id(),
                     .sample = ++sample_,
                     .status_seen = link_.status() ? link_.status()->status_sequence : 0,
                     .service_id_seen = link_.status() ? link_.status()->service_id : 0,
                     .epoch_seen = epoch,
                     .frame = static_cast<std::uint8_t>(plan.is_tool ? 1 : 0),
                     .joint = static_cast<std::uint8_t>(plan.joint),
                     .velocity = velocity,
                     .distance = plan.distance,
                     .dead_man_ns = static_cast<std::int64_t>(plan.dead_man_s * 1e9)});
}

/// However it ends, the machine gets the command to brake at once, not after the dead man's time: a
/// status that came late may say that it does not jog while it does.
JogHand::Grip JogHand::hold(const JogPlan& plan, const dds::Reply& reply,
                            const std::atomic<bool>& is_let_go) {
  const Grip grip = press(plan, reply, is_let_go);
  send(plan, reply.epoch, 0);
  return grip;
}

JogHand::Grip JogHand::press(const JogPlan& plan, const dds::Reply& reply,
                             const std::atomic<bool>& is_let_go) {
  const double from = position_of(link_, plan);
  const auto begin = Clock::now();
  JointVector seen = joints_of(link_);
  auto heard = begin, moved = begin;  // when the machine spoke, and was seen to move, last
  bool has_begun = false;
  for (auto now = begin; !is_let_go; now = Clock::now()) {
    const std::chrono::duration<double> held = now - begin;
    if (plan.time_s > 0 && held.count() >= plan.time_s) break;
    send(plan, reply.epoch, plan.velocity);
    std::this_thread::sleep_until(now + kBetweenSamples);
    if (!link_.wait_for_status(std::chrono::milliseconds(0))) {
      if (now - heard > kSilence) return Grip::kLost;
      continue;
    }
    heard = now;
    const bool is_jogging = link_.status()->state == State::kJogging;
    has_begun = has_begun || is_jogging || now - begin > kStartDelay;
    if (has_begun && !is_jogging) return Grip::kTakenOff;
    if (joints_of(link_) != seen) moved = now;
    seen = joints_of(link_);
    const double position = position_of(link_, plan);
    const bool is_there =
        plan.distance > 0 && std::abs(position - from) >= plan.distance - kSamePosition;
    // It stands at the end of its travel, or of the tool's way.
    const bool stands = now - moved > std::chrono::milliseconds(500);
    if (plan.time_s == 0 && (is_there || stands)) break;
  }
  return Grip::kKept;
}

JogResult JogHand::wait_for_rest(const JogPlan& plan, bool was_held) {
  const auto end = Clock::now() + kBraking;
  const auto is_over = [this] {
    const State state = link_.status()->state;
    return state != State::kJogging && state != State::kAborting && state != State::kFaultStop;
  };
  while (Clock::now() < end && !is_over()) (void)link_.wait_for_status(kBetweenSamples);
  const bool is_done = was_held && link_.status()->state == State::kReady;
  return {is_done ? JogEnd::kDone : JogEnd::kTakenOff, is_done ? "" : link_.status()->message,
          position_of(link_, plan)};
}

}  // namespace meridian::stream
