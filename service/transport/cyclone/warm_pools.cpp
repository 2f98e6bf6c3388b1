// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/warm_pools.hpp"

#include <dds/dds.h>
#include <dds/ddsi/q_freelist.h>
#include <idl/drives.h>

#include <string>

#include "service/transport/entity.hpp"

namespace meridian::dds {
namespace {

/// Three drawers and about 1000 samples in histories. Seven drawers of the stock come to be when
/// so many nodes are given back, one more is the giver's: no more than eight can ever be full.
constexpr std::int32_t kNodes = 7 * NN_FREELIST_MAGSIZE + 8;
constexpr const char* kName = "meridian/pools";

/// Keeps that many samples although nobody reads them.
dds_entity_t make_keeping_writer(Participant& participant, dds_entity_t topic) {
  const Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, kNodes, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return dds_create_writer(participant.publisher(), topic, qos.get(), nullptr);
}

}  // namespace

void warm_pools(Participant& participant) {
  const Entity topic(kName, dds_create_topic(participant.handle(), &meridian_wire_Setpoint_desc,
                                             kName, nullptr, nullptr));
  const Entity writer(kName, make_keeping_writer(participant, topic.handle()));
  const meridian_wire_Setpoint sample{};
  dds_return_t result = DDS_RETCODE_OK;
  for (std::int32_t i = 0; i < kNodes && result == DDS_RETCODE_OK; ++i) {
    result = dds_write(writer.handle(), &sample);
  }
  // The end of the instance gives its samples' nodes to the pool; deleting the writer would not.
  if (result == DDS_RETCODE_OK) result = dds_unregister_instance(writer.handle(), &sample);
  if (result != DDS_RETCODE_OK) {
    throw DdsError(std::string(kName) + ": " + dds_strretcode(-result));
  }
}

}  // namespace meridian::dds
