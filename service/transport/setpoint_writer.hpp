// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/writer.hpp"

struct ddsi_serdata;

namespace meridian::dds {

/// Sends setpoints without a heap call, whatever other threads do with DDS at the same time.
///
/// Cyclone takes the memory of every sample from a pool that all threads share. Small samples that
/// were received end up there too, and are reallocated when a setpoint does not fit into them; a
/// pool that another thread has emptied means malloc. So this writer serializes a few setpoints
/// once, keeps them, and overwrites their bytes in place whenever Cyclone has let go of them.
///
/// One exception: after a pause longer than the liveliness lease (100 ms, when drives that bridge a
/// few cycles have long stopped) the next write makes one heap call. It announces the writer anew,
/// and Cyclone does that by way of its garbage collector.
/// Proof: tests/unit/transport/setpoint_writer_test.cpp, tests/integration/counters_test.cpp.
class SetpointWriter {
 public:
  explicit SetpointWriter(Participant& participant);  ///< Throws DdsError.
  ~SetpointWriter();
  SetpointWriter(const SetpointWriter&) = delete;
  SetpointWriter& operator=(const SetpointWriter&) = delete;

  /// False: not sent. One thread writes at a time.
  [[nodiscard]] bool write(const SetpointSample& sample) noexcept;
  [[nodiscard]] int matched_readers() const noexcept { return writer_.matched_readers(); }
  /// How often the lease ran out between two writes.
  [[nodiscard]] std::uint64_t lease_losses() const noexcept;
  /// Samples that were written the ordinary way because Cyclone still held all prepared ones.
  [[nodiscard]] std::uint64_t written_unprepared() const noexcept { return unprepared_; }

 private:
  struct PreparedSample {
    ddsi_serdata* sample = nullptr;
    std::byte* payload = nullptr;  ///< its serialized fields
  };
  void prepare_samples(Participant& participant);

  Writer<SetpointSample> writer_;
  std::array<PreparedSample, 4> prepared_samples_{};
  std::size_t next_ = 0;
  std::uint64_t unprepared_ = 0;
};

}  // namespace meridian::dds
