// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/feedback_merge.hpp"

#include <algorithm>

#include "service/interpolator/drive_words.hpp"
#include "service/interpolator/monotonic.hpp"

namespace meridian::interpolator {

FeedbackMerge::Group* FeedbackMerge::find_group(std::uint32_t id) noexcept {
  for (Group& group : groups_) {
    if (group.source != 0 && group.id == id) return &group;
  }
  for (Group& group : groups_) {
    if (group.source == 0) return &group;
  }
  return nullptr;
}

bool FeedbackMerge::take(const dds::DriveFeedback& sample, std::uint64_t source,
                         std::int64_t now_ns) noexcept {
  Group* group = find_group(sample.drive_group);
  if (group == nullptr || source == 0 || sample.joint_mask == 0 ||
      (sample.joint_mask >> kMaxJoints) != 0) {
    return false;
  }
  if (group->source == source && sample.sample <= group->sample) return false;
  for (Group& other : groups_) {
    if (&other != group) other.joint_mask &= ~sample.joint_mask;
  }
  *group = {sample.drive_group,      source, sample.sample,
            sample.cycle_seen,       now_ns, sample.joint_mask,
            sample.is_emergency_stop};
  for (int joint = 0; joint < kMaxJoints; ++joint) {
    const std::uint32_t bit = 1U << joint;
    if ((sample.joint_mask & bit) == 0) continue;
    const auto i = static_cast<std::size_t>(joint);
    feedback_.position[i] = sample.position[i];
    words_.statusword[i] = sample.statusword[i];
    words_.error[i] = sample.error[i];
    const DriveState state = drive_state(sample.statusword[i]);
    const auto set = [bit](std::uint32_t& mask, bool is_set) {
      mask = is_set ? mask | bit : mask & ~bit;
    };
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
  merge();
  return true;
}

void FeedbackMerge::merge() noexcept {
  feedback_.arrival_ns = INT64_MAX;
  feedback_.cycle_seen = UINT64_MAX;
  feedback_.joint_mask = 0;
  feedback_.emergency_stop = false;
  for (const Group& group : groups_) {
    if (group.joint_mask == 0) continue;
    feedback_.arrival_ns = std::min(feedback_.arrival_ns, group.arrival_ns);
    feedback_.cycle_seen = std::min(feedback_.cycle_seen, group.cycle_seen);
    feedback_.joint_mask |= group.joint_mask;
    feedback_.emergency_stop = feedback_.emergency_stop || group.is_emergency_stop;
  }
  words_.joint_mask = feedback_.joint_mask;
  words_.enabled_mask = feedback_.enabled_mask;
  words_.fault_mask = feedback_.fault_mask;
}

FeedbackListener::FeedbackListener(dds::Participant& participant, Ports& ports)
    : ports_(ports),
      spans_(ports.spans != nullptr ? &ports.spans->receive : nullptr),
      reader_(participant, [this](auto& reader) { on_data(reader); }) {}

void FeedbackListener::on_data(dds::Reader<dds::DriveFeedback>& reader) noexcept {
  dds::DriveFeedback sample;
  dds::SampleInfo info;
  bool has_news = false;
  const std::int64_t begun_ns = spans_.is_on() ? monotonic_ns() : 0;
  while (reader.take(sample, info)) {
    if (!info.is_valid) continue;
    const std::int64_t now_ns = monotonic_ns();
    if (!merge_.take(sample, info.source, now_ns)) continue;
    has_news = true;
    report(now_ns);
    time_round_trip(sample.cycle_seen, now_ns);
  }
  if (!has_news) return;
  ports_.feedback.store(merge_.feedback());
  ports_.drive_words.store(merge_.words());
  ports_.drive_words_for_status.store(merge_.words());
  if (!spans_.is_on()) return;
  spans_.write(trace::Doing::kFeedback, begun_ns, monotonic_ns(), merge_.feedback().cycle_seen);
}

/// Telemetry that is held up loses reports: rows then carry an older one, and its cycle says so.
void FeedbackListener::report(std::int64_t now_ns) noexcept {
  const Feedback& feedback = merge_.feedback();
  const DriveWords& words = merge_.words();
  (void)ports_.drive_reports.try_push({.arrival_ns = now_ns,
                                       .cycle_seen = feedback.cycle_seen,
                                       .position = feedback.position,
                                       .statusword = words.statusword,
                                       .error = words.error,
                                       .joint_mask = feedback.joint_mask,
                                       .is_emergency_stop = feedback.emergency_stop});
}

void FeedbackListener::time_round_trip(std::uint64_t cycle, std::int64_t now_ns) noexcept {
  // Drives in several groups answer one after the other: the first to answer a cycle counts. What
  // this service did not send, cycles of one before it too, is no answer.
  const std::int64_t sent_ns = ports_.sent_times.sent_ns(cycle);
  if (sent_ns <= 0 || cycle <= answered_) return;
  answered_ = cycle;
  (void)ports_.round_trips.try_push(narrow_ns(now_ns - sent_ns));
}

}  // namespace meridian::interpolator
