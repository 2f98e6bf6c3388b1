// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/command_listener.hpp"

#include <algorithm>
#include <cstring>

#include "meridian/cycle/state_table.hpp"

namespace meridian::interpolator {
namespace {

[[nodiscard]] Arrival arrival_of(const dds::CommandRequest& request, std::uint64_t key,
                                 std::uint64_t source) noexcept {
  Arrival arrival;
  arrival.key = key;
  arrival.source = source;
  arrival.request = request.request;
  arrival.operator_id = request.operator_id;
  arrival.status_seen = request.status_seen;
  arrival.service_id_seen = request.service_id_seen;
  arrival.argument = request.argument;
  arrival.epoch_seen = request.epoch_seen;
  arrival.verb = request.verb;
  const std::size_t length =
      std::min(request.operator_name.size(), arrival.operator_name.size() - 1);
  std::memcpy(arrival.operator_name.data(), request.operator_name.data(), length);
  return arrival;
}

}  // namespace

CommandListener::CommandListener(dds::Participant& participant, const StatusClock& status_clock,
                                 Ports& ports)
    : status_clock_(status_clock),
      ports_(ports),
      reader_(participant, [this](auto& reader) { on_data(reader); }) {}

void CommandListener::on_data(dds::Reader<dds::CommandRequest>& reader) noexcept {
  dds::SampleInfo info;
  while (reader.take(request_, info)) {
    if (!info.is_valid) continue;
    const std::uint64_t key = ports_.commands.next_request();
    if (is_stop(request_.verb)) {
      // Whoever is to move the machine again must have seen a status of after the stop.
      ports_.stop_status.store(status_clock_.newest(), std::memory_order_release);
      ports_.commands.stage_stop(request_.verb, key);
    }
    if (request_.verb == Verb::kFrame) (void)ports_.set_up.orders.try_push({key, request_.frame});
    if (request_.verb == Verb::kTool) pass_tools(key);
    if (request_.verb == Verb::kLimits) (void)ports_.set_up.limits.try_push({key, request_.limits});
    if (!ports_.arrivals.try_push(arrival_of(request_, key, info.source))) {
      ports_.commands_dropped.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

/// Where there is no room its command is refused: what it says was lost.
void CommandListener::pass_tools(std::uint64_t key) noexcept {
  tools_.key = key;
  tools_.tools_seen = request_.tools_seen;
  tools_.file.fill('\0');
  const std::size_t length = std::min(request_.tool_file.size(), tools_.file.size() - 1);
  std::memcpy(tools_.file.data(), request_.tool_file.data(), length);
  (void)ports_.set_up.tool_files.try_push(tools_);
}

}  // namespace meridian::interpolator
