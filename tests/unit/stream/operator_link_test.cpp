// SPDX-License-Identifier: Apache-2.0
#include "service/stream/operator_link.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>

#include "support/private_domain.hpp"

/// An operator who means a dry run, at services that know of such words and at those of before,
/// which would take them for any other: the test is the service, and answers nothing.
namespace meridian::stream {
namespace {

using std::chrono::milliseconds;

class OperatorWhoMeansADryRun : public testing::Test {
 protected:
  void tell(bool is_dry_run) {
    dds::Status status;
    status.service_id = 1;
    status.status_sequence = ++sequence_;
    status.state = State::kLoaded;
    status.is_dry_run = is_dry_run;
    ASSERT_TRUE(statuses_.write(status));
  }
  /// What was sent, oldest first.
  [[nodiscard]] std::optional<dds::CommandRequest> sent() {
    dds::CommandRequest request;
    return commands_.take(request) ? std::optional(request) : std::nullopt;
  }

  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = "m"}};
  dds::Writer<dds::Status> statuses_{participant_};
  dds::Reader<dds::CommandRequest> commands_{participant_};
  dds::Writer<dds::Reply> replies_{participant_};
  OperatorLink link_{participant_, "test"};
  std::uint64_t sequence_ = 0;
};

TEST_F(OperatorWhoMeansADryRun, AsksNothingOfAMachineThatTellsOfNone) {
  ASSERT_NO_FATAL_FAILURE(tell(false));
  for (const Verb verb : {Verb::kEnable, Verb::kStart}) {
    const auto reply = link_.ask(verb, 1, milliseconds(200));
    ASSERT_TRUE(reply);
    EXPECT_FALSE(reply->is_accepted);
    EXPECT_EQ(reply->refusal, Refusal::kNotDryRun);
    EXPECT_NE(reply->text.find(" refused: it is for a dry run alone"), std::string::npos);
  }
  EXPECT_FALSE(sent()) << "a service of before would do it";
}

TEST_F(OperatorWhoMeansADryRun, AsksOnceTheMachineTellsOfIt) {
  ASSERT_NO_FATAL_FAILURE(tell(false));
  std::thread later([this] {
    std::this_thread::sleep_for(milliseconds(50));
    tell(true);
  });
  EXPECT_FALSE(link_.ask(Verb::kStart, 1, milliseconds(400))) << "nobody answers";
  later.join();
  const auto request = sent();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->argument, 1);
  EXPECT_EQ(request->status_seen, 2U) << "what it quotes told of the dry run";
}

TEST_F(OperatorWhoMeansADryRun, AsksNoMoreOnceTheMachineTellsThatItIsOver) {
  ASSERT_NO_FATAL_FAILURE(tell(true));
  std::thread later([this] {
    std::this_thread::sleep_for(milliseconds(50));
    tell(false);
  });
  EXPECT_FALSE(link_.ask(Verb::kEnable, 1, milliseconds(500))) << "the answer is still to come";
  later.join();
  EXPECT_TRUE(sent());
  EXPECT_FALSE(sent()) << "it would be repeated after 300 ms";
}

TEST_F(OperatorWhoMeansADryRun, IsNobodyWhoSaysItAsEver) {
  ASSERT_NO_FATAL_FAILURE(tell(false));
  EXPECT_FALSE(link_.ask(Verb::kStart, 0, milliseconds(100)));
  EXPECT_TRUE(sent());
}

TEST_F(OperatorWhoMeansADryRun, QuotesInARepetitionWhatHeSawWhenHeSaidIt) {
  ASSERT_NO_FATAL_FAILURE(tell(false));
  std::thread later([this] {
    std::this_thread::sleep_for(milliseconds(50));
    tell(false);
  });
  EXPECT_FALSE(link_.ask(Verb::kResume, 0, milliseconds(400))) << "nobody answers";
  later.join();
  const auto first = sent(), second = sent();
  ASSERT_TRUE(first && second) << "it is repeated after 300 ms";
  EXPECT_EQ(first->status_seen, 1U);
  EXPECT_EQ(second->status_seen, 1U) << "a stop may have been said behind it";
}

/// Who was heard once and says something while he is cut off.
TEST(OperatorWhoIsCutOff, QuotesWhatHeSawWhenHeSaidItOnceHeIsHeard) {
  const support::PrivateDomain domain;
  dds::Participant participant({.domain = domain.id(), .machine = "m"});
  dds::Writer<dds::Status> statuses(participant);
  OperatorLink link(participant, "test");
  const auto tell = [&statuses](std::uint64_t sequence) {
    dds::Status status;
    status.status_sequence = sequence;
    return statuses.write(status);
  };
  ASSERT_TRUE(tell(1));
  {
    const dds::Reader<dds::CommandRequest> before(participant);
    EXPECT_FALSE(link.ask(Verb::kHold, 0, milliseconds(50)));
  }
  std::optional<dds::Reader<dds::CommandRequest>> commands;
  std::thread later([&] {
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_TRUE(tell(2));
    std::this_thread::sleep_for(milliseconds(50));
    commands.emplace(participant);
  });
  EXPECT_FALSE(link.ask(Verb::kResume, 0, milliseconds(250)));
  later.join();
  dds::CommandRequest request;
  ASSERT_TRUE(commands->take(request));
  EXPECT_EQ(request.verb, Verb::kResume);
  EXPECT_EQ(request.status_seen, 1U);
}

}  // namespace
}  // namespace meridian::stream
