// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/operator_link.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "service/transport/sources.hpp"
#include "support/private_domain.hpp"

/// An operator who means a dry run, at services that know of such words and at those of before,
/// which would take them for any other: the test is the service.
namespace meridian::stream {
namespace {

using std::chrono::milliseconds;

class OperatorWhoMeansADryRun : public testing::Test {
 protected:
  void publish(bool is_dry_run) {
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
  /// The next that is sent, however long that takes.
  [[nodiscard]] std::optional<dds::CommandRequest> next_sent() {
    const auto patience = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < patience) {
      if (auto request = sent()) return request;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return std::nullopt;
  }
  void answer(const dds::CommandRequest& request) {
    dds::Reply reply;
    reply.request = request.request;
    reply.operator_id = request.operator_id;
    reply.verb = request.verb;
    reply.service_id = 1;
    reply.requester = dds::number_of(participant_);
    reply.is_accepted = true;
    EXPECT_TRUE(replies_.write(reply));
  }

  static constexpr milliseconds kPatience{5000};

  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = "m"}};
  dds::Writer<dds::Status> statuses_{participant_};
  dds::Reader<dds::CommandRequest> commands_{participant_};
  dds::Writer<dds::Reply> replies_{participant_};
  OperatorLink link_{participant_, "test"};
  std::uint64_t sequence_ = 0;
};

TEST_F(OperatorWhoMeansADryRun, AsksNothingOfAMachineThatReportsNone) {
  ASSERT_NO_FATAL_FAILURE(publish(false));
  for (const Verb verb : {Verb::kEnable, Verb::kStart}) {
    const auto reply = link_.ask(verb, 1, milliseconds(200));
    ASSERT_TRUE(reply);
    EXPECT_FALSE(reply->is_accepted);
    EXPECT_EQ(reply->refusal, Refusal::kNotDryRun);
    EXPECT_NE(reply->text.find(" refused: it is for a dry run alone"), std::string::npos);
  }
  EXPECT_FALSE(sent()) << "a service of before would do it";
}

TEST_F(OperatorWhoMeansADryRun, AsksOnceTheMachineReportsIt) {
  ASSERT_NO_FATAL_FAILURE(publish(false));
  std::thread service([this] {
    std::this_thread::sleep_for(milliseconds(50));
    publish(true);
    const auto request = next_sent();
    ASSERT_TRUE(request);
    EXPECT_EQ(request->argument, 1);
    EXPECT_EQ(request->status_seen, 2U) << "what it quotes reported the dry run";
    answer(*request);
  });
  EXPECT_TRUE(link_.ask(Verb::kStart, 1, kPatience));
  service.join();
}

TEST_F(OperatorWhoMeansADryRun, AsksNoMoreOnceTheMachineReportsThatItIsOver) {
  ASSERT_NO_FATAL_FAILURE(publish(true));
  std::thread service([this] {
    ASSERT_TRUE(next_sent());
    publish(false);
  });
  EXPECT_FALSE(link_.ask(Verb::kEnable, 1, milliseconds(500))) << "the answer is still to come";
  service.join();
  EXPECT_FALSE(sent()) << "it would be repeated after 300 ms";
}

TEST_F(OperatorWhoMeansADryRun, IsNobodyWhoSaysItAsEver) {
  ASSERT_NO_FATAL_FAILURE(publish(false));
  EXPECT_FALSE(link_.ask(Verb::kStart, 0, milliseconds(100)));
  EXPECT_TRUE(sent());
}

TEST_F(OperatorWhoMeansADryRun, QuotesInARepetitionWhatHeSawWhenHeSaidIt) {
  ASSERT_NO_FATAL_FAILURE(publish(false));
  std::thread service([this] {
    const auto first = next_sent();
    publish(false);
    const auto second = next_sent();
    ASSERT_TRUE(first && second) << "it is repeated after 300 ms";
    EXPECT_EQ(first->status_seen, 1U);
    EXPECT_EQ(second->status_seen, 1U) << "a stop may have been said after it";
    answer(*second);
  });
  EXPECT_TRUE(link_.ask(Verb::kResume, 0, kPatience));
  service.join();
}

/// Who was heard once and says something while he is cut off.
TEST(OperatorWhoIsCutOff, QuotesWhatHeSawWhenHeSaidItOnceHeIsHeard) {
  const support::PrivateDomain domain;
  dds::Participant participant({.domain = domain.id(), .machine = "m"});
  dds::Writer<dds::Status> statuses(participant);
  dds::Writer<dds::Reply> replies(participant);
  OperatorLink link(participant, "test");
  const auto publish = [&statuses](std::uint64_t sequence) {
    dds::Status status;
    status.service_id = 1;
    status.status_sequence = sequence;
    return statuses.write(status);
  };
  ASSERT_TRUE(publish(1));
  {
    const dds::Reader<dds::CommandRequest> before(participant);
    EXPECT_FALSE(link.ask(Verb::kHold, 0, milliseconds(50)));
  }
  std::thread service([&] {
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_TRUE(publish(2));
    std::this_thread::sleep_for(milliseconds(50));
    dds::Reader<dds::CommandRequest> commands(participant);
    dds::CommandRequest request;
    const auto patience = std::chrono::steady_clock::now() + milliseconds(5000);
    while (!commands.take(request) && std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_EQ(request.verb, Verb::kResume);
    EXPECT_EQ(request.status_seen, 1U);
    dds::Reply reply;
    reply.request = request.request;
    reply.operator_id = request.operator_id;
    reply.verb = request.verb;
    reply.service_id = 1;
    reply.requester = dds::number_of(participant);
    EXPECT_TRUE(replies.write(reply));
  });
  EXPECT_TRUE(link.ask(Verb::kResume, 0, milliseconds(5000)));
  service.join();
}

/// Services that speak for one machine, each a participant of its own, and an operator.
class OperatorAmongServices : public testing::Test {
 protected:
  struct Speaker {
    Speaker(std::uint32_t domain, std::uint64_t service_id)
        : id(service_id), participant({.domain = domain, .machine = "m"}) {}
    void speak() {
      dds::Status status;
      status.service_id = id;
      status.status_sequence = ++sequence;
      EXPECT_TRUE(statuses.write(status));
    }
    /// Answers the newest command, if there is one.
    void answer(std::uint64_t requester, bool is_accepted, Verb verb = Verb::kHold) {
      dds::CommandRequest request;
      while (commands.take(request)) {
        EXPECT_TRUE(replies.write({.request = request.request,
                                   .operator_id = request.operator_id,
                                   .service_id = id,
                                   .requester = requester,
                                   .verb = verb,
                                   .is_accepted = is_accepted,
                                   .text = std::to_string(id)}));
      }
    }
    std::uint64_t id, sequence = 0;
    dds::Participant participant;
    dds::Writer<dds::Status> statuses{participant};
    dds::Writer<dds::Reply> replies{participant};
    dds::Reader<dds::CommandRequest> commands{participant};
  };

  /// What the operator hears of a hold while `work` is done every few ms.
  template <class Work>
  std::optional<dds::Reply> hold(Work work, milliseconds timeout) {
    std::atomic<bool> is_over{false};
    std::thread services([&] {
      while (!is_over) {
        work();
        std::this_thread::sleep_for(milliseconds(5));
      }
    });
    const auto reply = link_.ask(Verb::kHold, 0, timeout);
    is_over = true;
    services.join();
    return reply;
  }

  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = "m"}};
  OperatorLink link_{participant_, "test"};
  std::uint64_t own_ = dds::number_of(participant_);
  Speaker real_{domain_.id(), 1}, fake_{domain_.id(), 2};
};

TEST_F(OperatorAmongServices, HearsThatAHoldIsAcceptedOnlyOnceEachHasAcceptedIt) {
  const auto both = [this] {
    real_.speak();
    fake_.speak();
    fake_.answer(own_, true);
  };
  EXPECT_FALSE(hold(both, milliseconds(1200))) << "the fake's answer is not the machine's";
  EXPECT_EQ(link_.services().size(), 2U);
  const auto reply = hold([&] { both(), real_.answer(own_, true); }, milliseconds(5000));
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->is_accepted);
}

TEST_F(OperatorAmongServices, HearsTheRefusalWhereOneAcceptsAndOneRefuses) {
  const auto reply = hold(
      [this] {
        real_.speak();
        fake_.speak();
        fake_.answer(own_, true);
        real_.answer(own_, false);
      },
      milliseconds(5000));
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->is_accepted);
  EXPECT_EQ(reply->text, "1");
}

TEST_F(OperatorAmongServices, TakesNoAnswerToAnotherParticipantOrOfAnotherVerbForHis) {
  const auto reply = hold(
      [this] {
        real_.speak();
        real_.answer(own_ + 1, true);
      },
      milliseconds(800));
  EXPECT_FALSE(reply) << "it went to somebody who quoted his number";
  EXPECT_FALSE(hold(
      [this] {
        real_.speak();
        real_.answer(own_, true, Verb::kRapidOverride);
      },
      milliseconds(800)));
}

}  // namespace
}  // namespace meridian::stream
