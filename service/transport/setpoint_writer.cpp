// SPDX-License-Identifier: Apache-2.0
#include "service/transport/setpoint_writer.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "service/transport/convert/convert.hpp"
#include "service/transport/cyclone/warm_pools.hpp"
#include "service/transport/entity.hpp"

namespace meridian::dds {
namespace {

using Wire = meridian_wire_Setpoint;

/// Serialized, a setpoint is the bytes of its struct: natural alignment, no padding between fields.
constexpr std::size_t kPayload_bytes = 124;
constexpr std::size_t kHeader_bytes = 4;
constexpr const char* kPreparedTopic = "meridian/setpoint_prepared";
static_assert(std::is_trivially_copyable_v<Wire>);
static_assert(offsetof(Wire, crc32c) + sizeof(Wire::crc32c) == kPayload_bytes);

/// The number of references that are held on a sample.
std::uint32_t references(const ddsi_serdata& sample) noexcept {
  return ddsrt_atomic_ld32(&sample.refc);
}

}  // namespace

SetpointWriter::SetpointWriter(Participant& participant) : writer_(participant) {
  warm_pools(participant);
  writer_.register_instance({});
  prepare_samples(participant);
}

SetpointWriter::~SetpointWriter() {
  for (const PreparedSample& prepared : prepared_samples_) {
    if (prepared.sample != nullptr) ddsi_serdata_unref(prepared.sample);
  }
}

/// A writer and a reader of this process on a topic of the same type: what the reader takes is the
/// very sample that Cyclone serialized, with a reference that is ours.
void SetpointWriter::prepare_samples(Participant& participant) {
  const Entity topic(kPreparedTopic,
                     dds_create_topic(participant.handle(), &meridian_wire_Setpoint_desc,
                                      kPreparedTopic, nullptr, nullptr));
  const Entity reader(kPreparedTopic, dds_create_reader(participant.subscriber(), topic.handle(),
                                                        nullptr, nullptr));
  const Entity writer(kPreparedTopic,
                      dds_create_writer(participant.publisher(), topic.handle(), nullptr, nullptr));
  SetpointSample pattern;
  pattern.setpoint.cycle = 0x0123456789abcdefULL;
  pattern.setpoint.position.fill(1.25);
  pattern.crc = 77;
  Wire wire{};
  to_wire(pattern, wire);
  for (PreparedSample& prepared : prepared_samples_) {
    dds_sample_info_t info;
    if (dds_write(writer.handle(), &wire) != DDS_RETCODE_OK ||
        dds_takecdr(reader.handle(), &prepared.sample, 1, &info, DDS_ANY_STATE) != 1) {
      throw DdsError("setpoints: Cyclone DDS did not hand back a sample of its own process");
    }
    ddsrt_iovec_t bytes;
    ddsi_serdata* const held =
        ddsi_serdata_to_ser_ref(prepared.sample, 0, kHeader_bytes + kPayload_bytes, &bytes);
    prepared.payload = static_cast<std::byte*>(bytes.iov_base) + kHeader_bytes;
    ddsi_serdata_to_ser_unref(held, &bytes);
    if (std::memcmp(prepared.payload, &wire, kPayload_bytes) != 0) {
      throw DdsError("setpoints: Cyclone DDS serializes them otherwise than this program expects");
    }
  }
}

bool SetpointWriter::write(const SetpointSample& sample) noexcept {
  for (std::size_t i = 0; i < prepared_samples_.size(); ++i) {
    const PreparedSample& prepared = prepared_samples_[next_];
    next_ = (next_ + 1) % prepared_samples_.size();
    if (references(*prepared.sample) != 1) continue;  // still being sent, or kept for its deadline
    Wire wire{};
    to_wire(sample, wire);
    std::memcpy(prepared.payload, &wire, kPayload_bytes);
    // Writing gives up one reference; the prepared sample keeps its own.
    return dds_writecdr(writer_.handle(), ddsi_serdata_ref(prepared.sample)) == DDS_RETCODE_OK;
  }
  ++unprepared_;
  return writer_.write(sample);
}

std::uint64_t SetpointWriter::lease_losses() const noexcept {
  dds_liveliness_lost_status_t lost{};
  (void)dds_get_liveliness_lost_status(writer_.handle(), &lost);
  return lost.total_count;
}

}  // namespace meridian::dds
