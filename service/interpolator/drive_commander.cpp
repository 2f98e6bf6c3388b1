// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/drive_commander.hpp"

#include "meridian/rt/state_table.hpp"
#include "service/interpolator/drive_words.hpp"

namespace meridian::interpolator {

DriveCommander::DriveCommander(dds::Participant& participant, int drive_count,
                               std::uint64_t service_id)
    : writer_(participant), drive_count_(drive_count), service_id_(service_id) {}

void DriveCommander::work(const CycleView& view, const DriveWords& words,
                          std::int64_t now_ns) noexcept {
  const bool is_wanted = is_enabled(view.record.state);
  for (int drive = 0; drive < drive_count_; ++drive) {
    const auto i = static_cast<std::size_t>(drive);
    const bool is_known = (words.joint_mask >> drive & 1U) != 0;
    const DriveState is =
        is_known ? drive_state(words.statusword[i]) : DriveState::kSwitchOnDisabled;
    std::uint16_t next = next_controlword(is, is_wanted);
    if (is == DriveState::kFault && now_ns < reset_until_ns_) next = controlword::kFaultReset;

    const bool is_homing = (view.homing.mode_mask >> drive & 1U) != 0;
    const bool is_searching = (view.homing.start_mask >> drive & 1U) != 0;
    const std::uint8_t mode = is_homing ? dds::kHomingMode : dds::kCyclicPositionMode;
    if (is_searching && is == DriveState::kOperationEnabled) next |= controlword::kStartHoming;

    dds::DriveCommand& sent = sent_[i];
    const bool is_news = sent.sample == 0 || sent.controlword != next || sent.mode != mode ||
                         sent.epoch != view.epoch;
    if (!is_news && now_ns - sent_ns_[i] < kRepeat_ns) continue;
    sent.drive = static_cast<std::uint16_t>(drive);
    sent.controlword = next;
    sent.mode = mode;
    sent.epoch = view.epoch;
    sent.service_id = service_id_;
    ++sent.sample;
    sent_ns_[i] = now_ns;
    (void)writer_.write(sent);
  }
}

}  // namespace meridian::interpolator
