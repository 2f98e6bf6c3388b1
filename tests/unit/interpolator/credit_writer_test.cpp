// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/credit_writer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "service/dds/reader.hpp"
#include "support/private_domain.hpp"

namespace meridian::interpolator {
namespace {

/// Sessions that begin and end, as many as there are between two looks.
void open_and_close(CreditWriter& writer, std::uint64_t& session) {
  for (int i = 0; i < CreditWriter::kEndsBetweenLooks; ++i) {
    ++session;
    writer.write({.session = session, .text = "opened"});
    writer.end({.session = session});
  }
}

class Credits : public testing::Test {
 protected:
  support::PrivateDomain domain_;
  dds::Participant service_{{.domain = domain_.id(), .machine = "m"}};
  dds::Participant station_{{.domain = domain_.id(), .machine = "m"}};
  dds::Reader<dds::Credit> heard_{station_};
  std::uint64_t session_ = 0;
};

TEST_F(Credits, KeepTheirWriterWhileReadersAcknowledge) {
  CreditWriter writer(service_, [](std::int32_t) { return CreditWriter::kMaxUnacknowledged; });
  const std::int32_t before = writer.handle();
  open_and_close(writer, session_);
  EXPECT_EQ(writer.handle(), before);
}

TEST_F(Credits, GetAnewWriterWhereAReaderNeverAcknowledgesAndAreHeardOn) {
  CreditWriter writer(service_, [](std::int32_t) { return CreditWriter::kMaxUnacknowledged + 1; });
  for (int round = 0; round < 3; ++round) {
    const std::int32_t before = writer.handle();
    open_and_close(writer, session_);
    EXPECT_NE(writer.handle(), before);
  }
  ++session_;
  dds::Credit credit;
  bool is_heard = false;
  for (int tries = 0; tries < 500 && !is_heard; ++tries) {
    writer.write({.session = session_, .text = "repeated"});
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    while (heard_.take(credit)) is_heard |= credit.session == session_;
  }
  EXPECT_TRUE(is_heard);
}

}  // namespace
}  // namespace meridian::interpolator
