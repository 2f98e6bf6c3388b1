// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/feedback_merge.hpp"

#include <algorithm>
#include <bit>

#include "service/daemon/ports/drive_words.hpp"

namespace meridian::interpolator {

namespace {

/// What stays of a source that is gone: its guard, which counts as open.
[[nodiscard]] DriveSource remains_of(const DriveSource& source) noexcept {
  if (source.guard == GuardInput::kNone) return {};
  DriveSource guard;
  guard.writer = source.writer;
  guard.group = source.group;
  guard.sample = source.sample;
  guard.first_ns = source.first_ns;
  guard.arrival_ns = source.arrival_ns;
  guard.guard = GuardInput::kOpen;
  return guard;
}

}  // namespace

DriveSource* FeedbackMerge::find_slot(std::uint64_t writer, std::uint32_t group,
                                      std::int64_t now_ns) noexcept {
  for (DriveSource& source : sources_.slots) {
    if (source.writer == writer && source.group == group) return &source;
  }
  for (DriveSource& source : sources_.slots) {
    if (source.writer == 0) return &source;
  }
  DriveSource* idlest = nullptr;
  for (DriveSource& source : sources_.slots) {
    const bool has_input =
        source.has_only_stop || source.is_emergency_stop || source.guard != GuardInput::kNone;
    const bool counts = source.bound_mask != 0 || has_input;
    if (counts || now_ns - source.arrival_ns <= kSilence_ns) continue;
    if (idlest == nullptr || source.arrival_ns < idlest->arrival_ns) idlest = &source;
  }
  if (idlest == nullptr) idlest = find_lost_guard(now_ns);
  if (idlest != nullptr) *idlest = {};
  return idlest;
}

/// Full of guards that are gone: that one is open counts from now on without saying whose.
DriveSource* FeedbackMerge::find_lost_guard(std::int64_t now_ns) noexcept {
  for (DriveSource& source : sources_.slots) {
    const bool is_missed =
        source.bound_mask != 0 || source.has_only_stop || source.is_emergency_stop;
    if (is_missed || source.guard == GuardInput::kNone || now_ns - source.arrival_ns <= kSilence_ns)
      continue;
    is_guard_lost_ = true;
    return &source;
  }
  return nullptr;
}

bool FeedbackMerge::take(const dds::DriveFeedback& sample, std::uint64_t writer,
                         std::int64_t now_ns, bool may_hand_over) noexcept {
  if (writer == 0 || (sample.joint_mask >> kMaxJoints) != 0) return false;
  DriveSource* const slot = find_slot(writer, sample.drive_group, now_ns);
  if (slot == nullptr) {
    sources_.is_full = true;
    if (sample.is_emergency_stop) stopped_ns_ = now_ns;
    if (sample.is_guard_open) opened_ns_ = now_ns;
    merge(now_ns);
    return true;
  }
  const bool is_new = slot->writer == 0;
  if (!is_new && sample.sample <= slot->sample) return false;
  slot->writer = writer;
  slot->group = sample.drive_group;
  slot->claimed_mask = sample.joint_mask & joints_;
  slot->sample = sample.sample;
  slot->cycle_seen = sample.cycle_seen;
  slot->master = sample.service_id;
  if (is_new) slot->first_ns = now_ns;
  slot->arrival_ns = now_ns;
  slot->has_only_stop = sample.joint_mask == 0;
  slot->is_emergency_stop = sample.is_emergency_stop;
  if (sample.is_guard_open) {
    slot->guard = GuardInput::kOpen;
  } else if (slot->guard == GuardInput::kOpen) {
    slot->guard = GuardInput::kShut;
  }
  slot->probe = sample.probe <= ProbeInput::kContact ? sample.probe : ProbeInput::kNone;
  take_guard(*slot, now_ns);
  bind(*slot, now_ns, may_hand_over);
  take_joints(sample, slot->joints());
  merge(now_ns);
  return true;
}

void FeedbackMerge::bind(DriveSource& source, std::int64_t now_ns, bool may_hand_over) noexcept {
  std::uint32_t kept = 0;
  for (DriveSource& other : sources_.slots) {
    if (&other == &source || other.bound_mask == 0) continue;
    const bool is_silent = now_ns - other.arrival_ns > kSilence_ns;
    const std::uint32_t reported = is_silent ? 0 : other.claimed_mask;
    if (may_hand_over) other.bound_mask &= reported | ~source.claimed_mask;
    kept |= other.bound_mask;
  }
  source.bound_mask |= source.claimed_mask & ~kept;
}

void FeedbackMerge::take_guard(DriveSource& source, std::int64_t now_ns) noexcept {
  for (DriveSource& other : sources_.slots) {
    const bool is_silent = now_ns - other.arrival_ns > kSilence_ns;
    // Only who came after the silence: who spoke all the while is another one.
    const bool is_heir = other.group == source.group && source.first_ns > other.arrival_ns;
    if (other.guard == GuardInput::kNone || !is_silent || !is_heir) continue;
    other.guard = GuardInput::kNone;
    if (source.guard == GuardInput::kNone) source.guard = GuardInput::kShut;
    const bool is_missed = other.bound_mask != 0 || other.has_only_stop;
    if (!is_missed && !other.is_emergency_stop) other = {};
  }
}

void FeedbackMerge::forget(std::uint64_t writer, std::int64_t now_ns, bool is_off) noexcept {
  bool has_more = false;
  for (DriveSource& source : sources_.slots) {
    const bool is_missed = !is_off && (source.bound_mask != 0 || source.has_only_stop);
    if (source.writer == writer && !is_missed) source = remains_of(source);
    has_more = has_more || source.writer == 0;
  }
  if (has_more) sources_.is_full = false;
  merge(now_ns);
}

void FeedbackMerge::take_joints(const dds::DriveFeedback& sample, std::uint32_t joints) noexcept {
  for (std::uint32_t left = joints; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    const std::uint32_t bit = 1U << i;
    feedback_.position[i] = sample.position[i];
    words_.statusword[i] = sample.statusword[i];
    words_.error[i] = sample.error[i];
    const DriveState state = drive_state(sample.statusword[i]);
    const auto set = [bit](std::uint32_t& mask, bool is_set) {
      mask = is_set ? mask | bit : mask & ~bit;
    };
    const bool is_obeyed = sample.service_id == service_id_ || sample.service_id == 0;
    set(feedback_.foreign_mask, service_id_ != 0 && !is_obeyed);
    set(feedback_.enabled_mask, state == DriveState::kOperationEnabled);
    set(feedback_.fault_mask, state == DriveState::kFault || state == DriveState::kFaultReaction);
    set(feedback_.referenced_mask, (sample.referenced_mask & bit) != 0);
    const bool is_homing = sample.mode_display[i] == dds::kHomingMode;
    const HomingWord homing = is_homing ? homing_word(sample.statusword[i]) : HomingWord{};
    set(feedback_.homing_mask, is_homing);
    set(feedback_.still_mask, homing.is_still);
    set(feedback_.homed_mask, homing.is_attained);
    set(feedback_.homing_error_mask, homing.has_failed);
  }
}

/// Stop input and guard count, whatever else is taken from a source.
void FeedbackMerge::merge_inputs(const DriveSource& source, std::int64_t now_ns) noexcept {
  if (source.is_emergency_stop) {
    feedback_.emergency_stop = true;
    feedback_.emergency_ns = std::max(feedback_.emergency_ns, source.arrival_ns);
  }
  const bool is_silent = now_ns - source.arrival_ns > kSilence_ns;
  const bool is_lost = source.guard == GuardInput::kShut && is_silent;
  if (source.guard == GuardInput::kOpen || is_lost) feedback_.is_guard_open = true;
}

void FeedbackMerge::merge(std::int64_t now_ns) noexcept {
  const DriveSource* oldest = nullptr;
  const DriveSource* deafest = nullptr;
  feedback_.joint_mask = feedback_.contested_mask = 0;
  feedback_.emergency_stop = stopped_ns_ != 0 && now_ns - stopped_ns_ <= kSilence_ns;
  feedback_.emergency_ns = feedback_.emergency_stop ? stopped_ns_ : 0;
  feedback_.probe = ProbeInput::kNone;
  const bool is_guard_heard = opened_ns_ != 0 && now_ns - opened_ns_ <= kSilence_ns;
  feedback_.is_guard_open = is_guard_lost_ || is_guard_heard;
  for (const DriveSource& source : sources_.slots) {
    if (source.writer == 0) continue;
    merge_inputs(source, now_ns);
    for (const DriveSource& other : sources_.slots) {
      if (other.writer == 0) continue;
      feedback_.contested_mask |= contested(source, other, now_ns, kSilence_ns);
    }
    if (source.joints() == 0 && !source.has_only_stop) continue;
    feedback_.probe = std::max(feedback_.probe, source.probe);
    if (oldest == nullptr || source.arrival_ns < oldest->arrival_ns) oldest = &source;
    if (source.joints() == 0) continue;
    if (deafest == nullptr || source.cycle_seen < deafest->cycle_seen) deafest = &source;
    feedback_.joint_mask |= source.joints();
    for (std::uint32_t left = source.joints(); left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      feedback_.joint_arrival_ns[i] = source.arrival_ns;
      feedback_.joint_cycle_seen[i] = source.cycle_seen;
    }
  }
  const auto lowest = [](const DriveSource* source) noexcept {
    const bool has_joint = source != nullptr && source->joints() != 0;
    return has_joint ? static_cast<std::uint8_t>(std::countr_zero(source->joints())) : kNoJoint;
  };
  feedback_.arrival_ns = oldest != nullptr ? oldest->arrival_ns : 0;
  feedback_.oldest_joint = oldest != nullptr ? lowest(oldest) : 0;
  feedback_.cycle_seen = deafest != nullptr ? deafest->cycle_seen : 0;
  feedback_.deafest_joint = deafest != nullptr ? lowest(deafest) : 0;
  words_.joint_mask = feedback_.joint_mask;
  words_.enabled_mask = feedback_.enabled_mask;
  words_.fault_mask = feedback_.fault_mask;
  words_.contested_mask = feedback_.contested_mask;
  words_.probe = feedback_.probe;
  words_.is_guard_open = feedback_.is_guard_open;
  words_.oldest_group = oldest != nullptr ? oldest->group : 0;
  words_.oldest_mask = oldest != nullptr ? oldest->joints() : 0;
}

}  // namespace meridian::interpolator
