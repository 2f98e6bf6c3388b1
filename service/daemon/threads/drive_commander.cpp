// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/drive_commander.hpp"

#include "service/daemon/ports/drive_words.hpp"

namespace meridian::interpolator {

DriveCommander::DriveCommander(dds::Participant& participant, int drive_count,
                               std::uint64_t service_id)
    : writer_(participant), drive_count_(drive_count), service_id_(service_id) {
  for (int drive = 0; drive < drive_count; ++drive) {
    writer_.register_instance({.drive = static_cast<std::uint8_t>(drive)});
  }
}

void DriveCommander::work(const DrivesAsked& asked, const DriveWords& words, std::int64_t reset_ns,
                          std::int64_t now_ns) noexcept {
  const bool is_reset = reset_ns != 0 && now_ns < reset_ns + kReset_ns;
  for (int drive = 0; drive < drive_count_; ++drive) {
    const auto i = static_cast<std::size_t>(drive);
    const DriveOrder next =
        next_order((words.joint_mask >> drive & 1U) != 0, words.statusword[i],
                   {.is_enabled = asked.is_enabled,
                    .work = drive_work(asked.homing_mask, asked.search_mask, i),
                    .is_reset = is_reset});
    dds::DriveCommand& sent = sent_[i];
    const bool is_news = sent.sample == 0 || sent.controlword != next.controlword ||
                         sent.mode != next.mode || sent.epoch != asked.epoch;
    if (!is_news && now_ns - sent_ns_[i] < kRepeat_ns) continue;
    sent.drive = static_cast<std::uint8_t>(drive);
    sent.controlword = next.controlword;
    sent.mode = next.mode;
    sent.epoch = asked.epoch;
    sent.service_id = service_id_;
    ++sent.sample;
    sent_ns_[i] = now_ns;
    (void)writer_.write(sent);
  }
}

}  // namespace meridian::interpolator
