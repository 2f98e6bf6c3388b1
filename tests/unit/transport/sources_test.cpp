// SPDX-License-Identifier: Apache-2.0
#include "service/transport/sources.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

/// Takes the next sample; its source, or 0 where none came in time.
template <class Message>
std::uint64_t next_source(Reader<Message>& reader, Writer<Message>& writer) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  Message message;
  SampleInfo info;
  while (std::chrono::steady_clock::now() < end) {
    (void)writer.write(Message{});
    while (reader.take(message, info)) {
      if (info.is_valid) return info.source;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return 0;
}

TEST(Sources, WritersOfOneParticipantAreKnownToBelongTogether) {
  const support::PrivateDomain domain;
  const ParticipantOptions options{.domain = domain.id(), .machine = "m"};
  Participant service(options), other(options), drives(options);
  Reader<SetpointSample> setpoints(drives);
  Reader<DriveCommand> commands(drives);
  std::optional<Writer<SetpointSample>> setpoint_writer(service);
  Writer<DriveCommand> command_writer(service);
  Writer<SetpointSample> others(other);
  const std::uint64_t setpoint = next_source(setpoints, *setpoint_writer);
  const std::uint64_t command = next_source(commands, command_writer);
  while (next_source(setpoints, others) == setpoint) {
  }
  const std::uint64_t stranger = next_source(setpoints, others);
  Senders senders;
  const std::uint64_t sender = senders.participant_of(setpoints.handle(), setpoint);
  EXPECT_NE(sender, 0U);
  EXPECT_EQ(senders.participant_of(commands.handle(), command), sender);
  EXPECT_NE(senders.participant_of(setpoints.handle(), stranger), sender);
  EXPECT_NE(senders.participant_of(setpoints.handle(), stranger), 0U);

  char host[256] = "";
  ASSERT_EQ(::gethostname(host, sizeof host - 1), 0);
  EXPECT_EQ(describe_source(drives, setpoints.handle(), setpoint),
            "process " + std::to_string(::getpid()) + " on host " + host);
  setpoint_writer.reset();
  EXPECT_EQ(participant_of(setpoints.handle(), setpoint), 0U);
  EXPECT_EQ(senders.participant_of(setpoints.handle(), setpoint), sender) << "as it was";
  EXPECT_EQ(describe_source(drives, setpoints.handle(), setpoint), "a writer that is gone");
}

TEST(Sources, AReaderOfADepthKeepsWhatTwoWroteUntilItIsTaken) {
  const support::PrivateDomain domain;
  const ParticipantOptions options{.domain = domain.id(), .machine = "m"};
  Participant service(options), other(options), drives(options);
  Reader<SetpointSample> setpoints(drives, {}, 4);
  Writer<SetpointSample> ours(service), theirs(other);
  (void)next_source(setpoints, ours);
  (void)next_source(setpoints, theirs);
  SetpointSample sample;
  while (setpoints.take(sample)) {
  }
  sample.setpoint.cycle = 1;
  ASSERT_TRUE(ours.write(sample));
  sample.setpoint.cycle = 2;
  ASSERT_TRUE(theirs.write(sample));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_TRUE(setpoints.take(sample));
  EXPECT_EQ(sample.setpoint.cycle, 1U);
  ASSERT_TRUE(setpoints.take(sample));
  EXPECT_EQ(sample.setpoint.cycle, 2U);
}

}  // namespace
}  // namespace meridian::dds
