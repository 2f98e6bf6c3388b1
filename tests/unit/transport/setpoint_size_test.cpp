// SPDX-License-Identifier: Apache-2.0
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include "service/transport/convert/convert.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

constexpr std::uint32_t kEncapsulation = 4;  // the CDR header before the fields

TEST(SetpointOnTheWire, Is124BytesSoThatWritingMakesNoHeapCall) {
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "size"});
  const dds_entity_t topic = dds_create_topic(participant.handle(), &meridian_wire_Setpoint_desc,
                                              "size", nullptr, nullptr);
  const dds_entity_t reader = dds_create_reader(participant.handle(), topic, nullptr, nullptr);
  const dds_entity_t writer = dds_create_writer(participant.handle(), topic, nullptr, nullptr);
  meridian_wire_Setpoint sample{};
  ASSERT_EQ(dds_write(writer, &sample), DDS_RETCODE_OK);
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  ASSERT_EQ(dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE), 1);
  EXPECT_EQ(ddsi_serdata_size(data) - kEncapsulation, 124U);
  ddsi_serdata_unref(data);
}

}  // namespace
}  // namespace meridian::dds
