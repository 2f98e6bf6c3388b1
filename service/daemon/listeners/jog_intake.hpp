// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/jog/jogging.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::interpolator {

/// Checks what comes in on `jog`: one operator jogs, the one whose verb `jog` was accepted with the
/// cycle's number for it, and each of his samples comes from his participant, is newer than the
/// last and quotes the epoch in force and a status that this service published. What anybody else
/// sends changes nothing. How long a sample was under way nobody knows; that it was said before its
/// operator saw the next status the service does know, by its own clock, and counts as silence. One
/// thread. Proof: tests/unit/daemon/jog_intake_test.cpp.
class JogIntake {
 public:
  explicit JogIntake(std::uint64_t service_id) noexcept : service_id_(service_id) {}

  /// `participant` (dds::participant_of()) jogs from now on: he and nobody who quotes his number.
  void begin(std::uint64_t operator_id, std::uint64_t participant, std::uint64_t hand) noexcept {
    hand_ = hand;
    if (operator_id != holder_ || participant != participant_) newest_ = 0;
    holder_ = operator_id;
    participant_ = participant;
    is_held_ = true;
  }
  void end() noexcept { is_held_ = false; }

  /// Returns the order that `jog` is for the cycle, with a tool of that length in the spindle;
  /// orders of all operators are counted as one row. `superseded_ns`: StatusTimes::superseded_for()
  /// of the status that it quotes; letting go (velocity 0) is taken without.
  [[nodiscard]] std::optional<JogOrder> take(const dds::Jog& jog, std::uint64_t participant,
                                             std::uint16_t epoch, int joint_count,
                                             double tool_length_mm,
                                             std::optional<std::int64_t> superseded_ns) noexcept {
    const bool is_of_holder = is_held_ && jog.operator_id == holder_ &&
                              participant == participant_ && jog.sample > newest_;
    const bool is_sound = std::isfinite(jog.velocity) && std::isfinite(jog.distance) &&
                          jog.frame <= 1 &&
                          jog.joint < (jog.frame == 1 ? kToolAxisCount : joint_count) &&
                          jog.distance >= 0 && jog.dead_man_ns > 0;
    const bool is_of_us = jog.service_id_seen == 0 || jog.service_id_seen == service_id_;
    const bool is_reported = (superseded_ns && is_of_us) || jog.velocity == 0;
    if (!is_of_holder || !is_sound || !is_reported || jog.epoch_seen != epoch) return std::nullopt;
    newest_ = jog.sample;
    return JogOrder{
        .sample = ++orders_,
        .epoch = epoch,
        .is_tool = jog.frame == 1,
        .joint = jog.joint,
        .velocity = jog.velocity,
        .distance = jog.distance,
        .tool_length_mm = tool_length_mm,
        .dead_man_s = std::min(kLongestDeadMan_s, 1e-9 * static_cast<double>(jog.dead_man_ns)),
        .hand = hand_,
        .age_s = 1e-9 * static_cast<double>(superseded_ns.value_or(0))};
  }

 private:
  std::uint64_t service_id_;
  bool is_held_ = false;
  std::uint64_t holder_ = 0;       ///< the operator who jogs, or did last
  std::uint64_t participant_ = 0;  ///< his
  std::uint64_t hand_ = 0;         ///< Command::request of his `jog`
  std::uint64_t newest_ = 0, orders_ = 0;
};

}  // namespace meridian::interpolator
