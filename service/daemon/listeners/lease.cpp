// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/lease.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "service/daemon/ports/monotonic.hpp"
#include "service/transport/sources.hpp"

namespace meridian::interpolator {

Lease::Lease(dds::Participant& participant, const dds::MachineInfo& claim, Report report)
    : participant_(participant),
      claim_(claim),
      report_(std::move(report)),
      reader_(participant),
      writer_(participant),
      check_(claim.service_id) {
  say();
}

void Lease::hold() {
  check_.hold(monotonic_ns());
  say();
}

void Lease::set_up(const WorkFrames& frames, const SetUpInForce& in_force,
                   const std::string& tool_file, bool is_reported) {
  claim_.frame_rotation = in_force.rotation;
  claim_.frame_origin_mm = in_force.origin_mm;
  claim_.work_frame = in_force.number;
  claim_.work_frames.assign(frames.rows().begin(), frames.rows().end());
  claim_.soft_limits = in_force.soft_limits;
  claim_.tool_file = tool_file;
  if (is_reported) say();
}

void Lease::say() {
  const LeaseCheck::Word word = check_.word(monotonic_ns());
  claim_.is_serving = word.is_serving;
  claim_.served_ns = word.served_ns;
  if (writer_.write(claim_)) check_.on_said(word, monotonic_ns());
}

void Lease::take(const dds::MachineInfo& info, std::uint64_t source) {
  // Who says another id than before has the place of before, and none more.
  std::erase_if(others_, [&](const Other& known) {
    const bool is_replaced = known.source == source && known.info.service_id != info.service_id;
    if (is_replaced) check_.forget(known.info.service_id);
    return is_replaced;
  });
  const bool is_heard = check_.hear(
      {.service_id = info.service_id, .is_serving = info.is_serving, .served_ns = info.served_ns},
      monotonic_ns());
  if (!is_heard) return report_once(source, "claims this machine implausibly, or as one too many");
  auto other = std::find_if(others_.begin(), others_.end(), [&](const Other& known) {
    return known.info.service_id == info.service_id;
  });
  if (other == others_.end()) other = others_.insert(others_.end(), Other{});
  *other = {.info = info, .source = source};
}

void Lease::report_once(std::uint64_t source, const char* what) {
  if (std::find(reported_.begin(), reported_.end(), source) != reported_.end()) return;
  reported_[next_reported_++ % reported_.size()] = source;
  if (!report_) return;
  report_(dds::describe_source(participant_, reader_.handle(), source) + ' ' + what +
          ": what it says is passed over");
}

void Lease::look() {
  dds::MachineInfo info;
  dds::SampleInfo sample;
  while (reader_.take(info, sample)) {
    if (sample.is_valid && info.service_id != claim_.service_id) take(info, sample.source);
  }
  std::erase_if(others_, [this](const Other& other) {
    const bool is_gone = !reader_.has_source(other.source);
    if (is_gone) check_.forget(other.info.service_id);
    return is_gone;
  });
}

std::optional<dds::MachineInfo> Lease::find_keeper(bool may_leave, std::uint64_t master) {
  const std::int64_t before_ns = monotonic_ns();
  look();
  check_.check(before_ns, may_leave, master);
  if (check_.has_to_speak(before_ns)) say();
  const auto keeper = check_.keeper(before_ns);
  if (!keeper) return std::nullopt;
  const auto found = std::find_if(others_.begin(), others_.end(), [&](const Other& other) {
    return other.info.service_id == *keeper;
  });
  return found != others_.end() ? std::optional(found->info) : std::nullopt;
}

std::optional<dds::MachineInfo> Lease::find_holder(std::chrono::milliseconds start_window,
                                                   std::chrono::milliseconds patience) {
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    const auto holder = find_keeper(true);
    const auto waited = std::chrono::steady_clock::now() - start;
    if (!holder && waited >= start_window) return std::nullopt;
    if (holder && waited >= patience) return holder;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace meridian::interpolator
