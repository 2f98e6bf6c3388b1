// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "service/drives/kit/pace.hpp"
#include "service/drives/simulated/check/checked_drives.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::drives {

/// Drives on the wire, checked at the machine's cycle time by two participants of this process.
class CheckWire : public CheckedDrives {
 public:
  /// `ask`: reaches the operator, and does not wait. Throws DdsError.
  CheckWire(const dds::ParticipantOptions& options, std::int64_t cycle_ns,
            std::function<void(Wish)> ask);

  void say(Speaker who, const dds::MachineInfo& machine) override;
  void say(Speaker who, const dds::DriveCommand& command) override;
  void say(Speaker who, const dds::SetpointSample& setpoint) override;
  void end(Speaker who) override;
  void begin(Speaker who) override;
  void ask(Wish wish) override { ask_(wish); }
  [[nodiscard]] bool period(std::vector<dds::DriveFeedback>& reports) override;
  [[nodiscard]] std::int64_t now_ns() const override { return drive::monotonic_ns(); }

 private:
  struct Voice {
    explicit Voice(const dds::ParticipantOptions& options) : participant(options) {}
    dds::Participant participant;
    dds::Writer<dds::MachineInfo> machines{participant};
    dds::Writer<dds::DriveCommand> commands{participant};
    dds::Writer<dds::SetpointSample> setpoints{participant};
  };
  [[nodiscard]] Voice* voice(Speaker who) noexcept {
    return who == Speaker::kOther ? &other_ : service_.get();
  }

  static constexpr int kDepth = 64;  ///< reports that wait
  dds::ParticipantOptions options_;
  std::function<void(Wish)> ask_;
  Voice other_;
  dds::Reader<dds::DriveFeedback> reports_;
  std::unique_ptr<Voice> service_;
  drive::Pace pace_;
};

}  // namespace meridian::drives
