// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "attack/wire.hpp"

namespace attack {

/// Sees the honest service and the honest drives, known from strangers by their process, and keeps
/// account of what must not be: drives that move where the machine rests, and drives that report a
/// stranger's setpoint. Poll it every millisecond.
class Observer {
 public:
  Observer(const Wire& wire, long service_process, long drives_process);

  void poll();

  [[nodiscard]] bool has_status() const noexcept { return status_.service_id != 0; }
  [[nodiscard]] const meridian_wire_Status& status() const noexcept { return status_; }
  /// When it came, monotonic.
  [[nodiscard]] std::int64_t status_ns() const noexcept { return status_ns_; }
  /// Whether this sample of a reader is of the honest service.
  [[nodiscard]] bool is_of_service(dds_entity_t reader, dds_instance_handle_t writer);

  /// Whether the joints' speed was constant, and not zero, over the last 40 setpoints.
  [[nodiscard]] bool is_cruising() const;
  [[nodiscard]] double speed() const { return seen_.empty() ? 0 : seen_.back().speed; }
  /// due_ns of the first setpoint behind `since_ns` that is slower than `reference`; 0: none yet.
  [[nodiscard]] std::int64_t slower_since(std::int64_t since_ns, double reference) const;

  struct Account {
    std::uint64_t setpoints = 0;            ///< of the honest service, seen
    std::uint64_t strangers_setpoints = 0;  ///< of others, seen
    std::uint64_t followed = 0;             ///< reports of drives that name a stranger's setpoint
    std::uint64_t reports = 0;
    std::array<double, 6> moved_ready{}, moved_off{}, moved_fault{};  ///< mm or rad, largest
    /// Reports of an enabled drive more than `kSwitchOff_ns` behind a status of Off or Fault.
    std::uint64_t enabled_at_rest = 0;
    /// How long after the first setpoint without "follow me" the first controlword without
    /// "operation enabled" was written, by the service's own time stamps, ms; negative: before it.
    std::vector<double> off_ms{};
  };
  [[nodiscard]] const Account& account() const noexcept { return account_; }

 private:
  enum class Source : std::uint8_t { kUnknown, kService, kDrives, kStranger };
  struct Seen {
    std::int64_t due_ns;
    double speed;
  };
  [[nodiscard]] Source source_of(dds_entity_t reader, dds_instance_handle_t writer);
  void take_setpoints();
  void take_status();
  void take_feedback();
  void take_controlwords();
  void rest(const meridian_wire_Feedback& feedback);
  void end_rest(std::uint8_t next_state);

  const Wire& wire_;
  long service_process_, drives_process_;
  dds_entity_t setpoints_, statuses_, feedbacks_, controlwords_;
  std::map<std::pair<dds_entity_t, dds_instance_handle_t>, Source> sources_;
  meridian_wire_Status status_{};
  std::int64_t status_ns_ = 0;
  std::deque<Seen> seen_;

  /// When something was switched off last, by the time stamp of the sample that said so.
  struct Switch {
    bool is_on = false;
    std::int64_t on_ns = 0, off_ns = 0;
    /// Whether it is switched off by this sample.
    bool goes_off(bool is_on_now, std::int64_t at_ns) noexcept {
      const bool goes = is_on && !is_on_now;
      if (!is_on && is_on_now) on_ns = at_ns;
      is_on = is_on_now;
      if (goes) off_ns = at_ns;
      return goes;
    }
  };
  void compare_switches();
  Switch following_, operating_;

  std::int64_t rest_since_ns_ = 0;
  bool has_base_ = false;
  std::uint64_t enabled_ = 0;          ///< reports of a drive that is on, not counted yet
  std::int64_t enabled_since_ns_ = 0;  ///< the first of them
  std::array<double, 6> base_{}, largest_{};
  Account account_;
};

}  // namespace attack
