// SPDX-License-Identifier: Apache-2.0
#include "attack/observer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "attack/samples.hpp"

namespace attack {
namespace {

// meridian::State
constexpr std::uint8_t kOff = 0, kReady = 2, kFaultStop = 12, kFault = 13;
constexpr std::int64_t kSettle_ns = 300'000'000;  ///< the shafts' own lag behind the last setpoint
constexpr std::int64_t kSwitchOff_ns = 300'000'000;
constexpr std::int64_t kSwitchOn_ns =
    100'000'000;  ///< from drives that are on to the status that says so
constexpr std::size_t kCruise = 40;
constexpr double kSteady = 5e-5, kSlower = 2e-4;  ///< of the speed
constexpr std::uint16_t kOperationEnabled = 0x27, kStateMask = 0x6f, kEnableOperation = 0x0f;
constexpr std::size_t kKept = 20'000;

[[nodiscard]] bool is_rest(std::uint8_t state) {
  return state == kOff || state == kReady || state == kFault;
}

}  // namespace

Observer::Observer(const Wire& wire, long service_process, long drives_process)
    : wire_(wire),
      service_process_(service_process),
      drives_process_(drives_process),
      setpoints_(wire.reader(topic_named("setpoint"), {.depth = 4096})),
      statuses_(wire.reader(topic_named("status"), {.depth = 64})),
      feedbacks_(wire.reader(topic_named("feedback"), {.depth = 4096})),
      controlwords_(wire.reader(topic_named("drive_command"), {.depth = 64})) {}

Observer::Source Observer::source_of(dds_entity_t reader, dds_instance_handle_t writer) {
  Source& source = sources_[{reader, writer}];
  if (source != Source::kUnknown) return source;
  const long process = wire_.process_of(reader, writer);
  if (process == 0) return Source::kUnknown;
  source = process == service_process_  ? Source::kService
           : process == drives_process_ ? Source::kDrives
                                        : Source::kStranger;
  return source;
}

bool Observer::is_of_service(dds_entity_t reader, dds_instance_handle_t writer) {
  return source_of(reader, writer) == Source::kService;
}

void Observer::poll() {
  take_status();
  take_setpoints();
  take_feedback();
  take_controlwords();
}

void Observer::take_controlwords() {
  meridian_wire_DriveCommand sample;
  void* samples[1] = {&sample};
  dds_sample_info_t info;
  while (dds_take(controlwords_, samples, &info, 1, 1) == 1) {
    const bool is_asked = info.valid_data && sample.drive == 0 &&
                          is_of_service(controlwords_, info.publication_handle);
    if (!is_asked) continue;
    const bool is_on = (sample.controlword & kEnableOperation) == kEnableOperation;
    if (operating_.goes_off(is_on, info.source_timestamp)) compare_switches();
  }
}

/// Where both were switched off just now, and both had been on together.
void Observer::compare_switches() {
  const bool are_both_off = !operating_.is_on && !following_.is_on;
  const bool were_both_on =
      following_.off_ns > operating_.on_ns && operating_.off_ns > following_.on_ns;
  if (!are_both_off || !were_both_on) return;
  account_.off_ms.push_back(1e-6 * static_cast<double>(operating_.off_ns - following_.off_ns));
}

void Observer::take_setpoints() {
  meridian_wire_Setpoint sample;
  void* samples[1] = {&sample};
  dds_sample_info_t info;
  while (dds_take(setpoints_, samples, &info, 1, 1) == 1) {
    if (!info.valid_data) continue;
    if (source_of(setpoints_, info.publication_handle) != Source::kService) {
      ++account_.strangers_setpoints;
      continue;
    }
    ++account_.setpoints;
    if (following_.goes_off((sample.flags & 1U) != 0, info.source_timestamp)) compare_switches();
    double square = 0;
    for (const double v : sample.velocity) square += v * v;
    seen_.push_back({sample.due_ns, std::sqrt(square)});
    if (seen_.size() > kKept) seen_.pop_front();
  }
}

void Observer::take_status() {
  meridian_wire_Status sample;
  void* samples[1] = {&sample};
  dds_sample_info_t info;
  while (dds_take(statuses_, samples, &info, 1, 1) == 1) {
    if (!info.valid_data || !is_of_service(statuses_, info.publication_handle)) continue;
    if (sample.status_sequence <= status_.status_sequence &&
        sample.service_id == status_.service_id) {
      continue;
    }
    const bool is_new = sample.state != status_.state || sample.service_id != status_.service_id;
    if (is_new) end_rest(sample.state);
    status_ns_ = monotonic_ns();
    if (is_new) {
      enabled_ = 0;  // drives that are switched on are ahead of the status that says so
    } else if (enabled_ > 0 && status_ns_ - enabled_since_ns_ > kSwitchOn_ns) {
      account_.enabled_at_rest += std::exchange(enabled_, 0);
    }
    status_ = sample;
    if (is_new) rest_since_ns_ = status_ns_;
  }
}

/// What moved at rest counts where no motion that the machine began explains it.
void Observer::end_rest(std::uint8_t next_state) {
  const bool is_explained = !is_rest(next_state) && next_state != kFaultStop;
  if (has_base_ && is_rest(status_.state) && !is_explained) {
    auto& moved = status_.state == kReady ? account_.moved_ready
                  : status_.state == kOff ? account_.moved_off
                                          : account_.moved_fault;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = std::max(moved[i], largest_[i]);
  }
  // From one rest to the next nothing may move: the base stays.
  if (!(is_rest(status_.state) && is_rest(next_state))) has_base_ = false;
  largest_.fill(0);
}

void Observer::take_feedback() {
  meridian_wire_Feedback sample;
  void* samples[1] = {&sample};
  dds_sample_info_t info;
  while (dds_take(feedbacks_, samples, &info, 1, 1) == 1) {
    if (!info.valid_data || source_of(feedbacks_, info.publication_handle) != Source::kDrives) {
      continue;
    }
    ++account_.reports;
    if (sample.cycle_seen >= kMark) ++account_.followed;
    rest(sample);
  }
}

void Observer::rest(const meridian_wire_Feedback& feedback) {
  if (!is_rest(status_.state)) return;
  const std::int64_t since_ns = monotonic_ns() - rest_since_ns_;
  if (status_.state != kReady && since_ns > kSwitchOff_ns) {
    const bool is_enabled =
        std::any_of(std::begin(feedback.statusword), std::end(feedback.statusword),
                    [](std::uint16_t word) { return (word & kStateMask) == kOperationEnabled; });
    if (is_enabled && enabled_++ == 0) enabled_since_ns_ = monotonic_ns();
  }
  if (!has_base_) {
    if (since_ns < kSettle_ns) return;
    std::copy(std::begin(feedback.position), std::end(feedback.position), base_.begin());
    has_base_ = true;
  }
  for (std::size_t i = 0; i < base_.size(); ++i) {
    largest_[i] = std::max(largest_[i], std::abs(feedback.position[i] - base_[i]));
  }
}

bool Observer::is_cruising() const {
  if (seen_.size() < kCruise || seen_.back().speed < 1e-3) return false;
  const double now = seen_.back().speed;
  return std::all_of(seen_.end() - kCruise, seen_.end(),
                     [now](const Seen& one) { return std::abs(one.speed - now) <= kSteady * now; });
}

std::int64_t Observer::slower_since(std::int64_t since_ns, double reference) const {
  for (auto one =
           std::lower_bound(seen_.begin(), seen_.end(), since_ns,
                            [](const Seen&seen, std::int64_t ns) { return seen.due_ns < ns; });
       one != seen_.end(); ++one) {
    if (one->speed < (1 - kSlower) * reference) return one->due_ns;
  }
  return 0;
}

}  // namespace attack
