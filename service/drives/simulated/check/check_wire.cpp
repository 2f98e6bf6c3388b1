// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/check/check_wire.hpp"

#include <utility>

namespace meridian::drives {

CheckWire::CheckWire(const dds::ParticipantOptions& options, std::int64_t cycle_ns,
                     std::function<void(Wish)> ask)
    : options_(options),
      ask_(std::move(ask)),
      other_(options),
      reports_(other_.participant, {}, kDepth),
      service_(std::make_unique<Voice>(options)),
      pace_(cycle_ns) {}

void CheckWire::say(Speaker who, const dds::MachineInfo& machine) {
  if (Voice* const one = voice(who)) static_cast<void>(one->machines.write(machine));
}

void CheckWire::say(Speaker who, const dds::DriveCommand& command) {
  if (Voice* const one = voice(who)) static_cast<void>(one->commands.write(command));
}

void CheckWire::say(Speaker who, const dds::SetpointSample& setpoint) {
  if (Voice* const one = voice(who)) static_cast<void>(one->setpoints.write(setpoint));
}

void CheckWire::end(Speaker who) {
  if (who == Speaker::kService) service_.reset();
}

void CheckWire::begin(Speaker who) {
  if (who == Speaker::kService) service_ = std::make_unique<Voice>(options_);
}

bool CheckWire::period(std::vector<dds::DriveFeedback>& reports) {
  constexpr int kMayBeLost = 6;  // of what the drives bridge
  const int lost = pace_.sleep();
  for (dds::DriveFeedback report; reports_.take(report);) reports.push_back(report);
  return lost <= kMayBeLost;
}

}  // namespace meridian::drives
