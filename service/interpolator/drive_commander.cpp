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
  const bool is_wanted = is_enabled(view.record.state) && !view.is_dry_run;
  for (int drive = 0; drive < drive_count_; ++drive) {
    const auto i = static_cast<std::size_t>(drive);
    const DriveOrder next = next_order((words.joint_mask >> drive & 1U) != 0, words.statusword[i],
                                       {.is_enabled = is_wanted,
                                        .is_homing = (view.homing.mode_mask >> drive & 1U) != 0,
                                        .is_searching = (view.homing.start_mask >> drive & 1U) != 0,
                                        .is_reset = now_ns < reset_until_ns_});
    dds::DriveCommand& sent = sent_[i];
    const bool is_news = sent.sample == 0 || sent.controlword != next.controlword ||
                         sent.mode != next.mode || sent.epoch != view.epoch;
    if (!is_news && now_ns - sent_ns_[i] < kRepeat_ns) continue;
    sent.drive = static_cast<std::uint8_t>(drive);
    sent.controlword = next.controlword;
    sent.mode = next.mode;
    sent.epoch = view.epoch;
    sent.service_id = service_id_;
    ++sent.sample;
    sent_ns_[i] = now_ns;
    (void)writer_.write(sent);
  }
}

}  // namespace meridian::interpolator
