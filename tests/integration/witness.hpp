// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <mutex>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/wire_recording.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::test {

/// Sees every setpoint that comes over the wire: what the drives were commanded, whoever dies. Of
/// machines without an actuator stage.
class Witness {
 public:
  explicit Witness(dds::Participant& participant)
      : setpoints_(
            participant,
            [this](dds::Reader<dds::SetpointSample>& reader) {
              const std::lock_guard lock(mutex_);
              for (dds::SetpointSample sample; reader.take(sample);) {
                seen_.push_back(sample.setpoint);
              }
            },
            kDepth) {}

  /// The newest since take() was called last; cycle 0: none was seen since.
  [[nodiscard]] Setpoint newest() const {
    const std::lock_guard lock(mutex_);
    return seen_.empty() ? Setpoint{} : seen_.back();
  }
  /// All since the last call.
  [[nodiscard]] std::vector<Setpoint> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(seen_, {});
  }

 private:
  static constexpr int kDepth = 256;
  mutable std::mutex mutex_;
  std::vector<Setpoint> seen_;
  dds::Reader<dds::SetpointSample> setpoints_;  ///< last: it calls what uses the others
};

/// Writes `setpoints` as a recording.
inline void write_recording(const std::vector<Setpoint>& setpoints, const MachineModel& model,
                            const std::filesystem::path& file) {
  auto writer = record::WireWriter::create(file.string(), model);
  ASSERT_TRUE(writer.has_value()) << writer.error().text();
  std::uint64_t cycle = 0;
  for (const Setpoint& setpoint : setpoints) {
    if (setpoint.cycle <= cycle) continue;  // came twice
    cycle = setpoint.cycle;
    record::WireRow row;
    row.setpoint = setpoint;
    ASSERT_TRUE(writer->write(row));
  }
  ASSERT_TRUE(writer->close());
}

}  // namespace meridian::test
