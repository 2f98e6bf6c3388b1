// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <initializer_list>
#include <thread>

#include "service/protocol/operator/operator_link.hpp"
#include "support/private_domain.hpp"

namespace meridian::stream {
namespace {

using std::chrono::milliseconds;

/// An operator who waits for what a verb leads to.
class OperatorWhoWaits : public testing::Test {
 protected:
  void show(State state) {
    dds::Status status;
    status.service_id = 1;
    status.status_sequence = ++sequence_;
    status.state = state;
    EXPECT_TRUE(statuses_.write(status));
  }
  /// What the machine shows once the reply is older than whatever is under way, the last of it
  /// again and again. Returns the sequence of the status that ended the wait; 0: none did.
  [[nodiscard]] std::uint64_t wait_for_ready(std::initializer_list<State> shown) {
    std::atomic<bool> is_over{false};
    std::thread service([&] {
      std::this_thread::sleep_for(milliseconds(350));
      for (const State state : shown) {
        show(state);
        std::this_thread::sleep_for(milliseconds(100));
      }
      for (; !is_over; std::this_thread::sleep_for(milliseconds(50))) show(*(shown.end() - 1));
    });
    const dds::Reply reply{.service_id = 1, .state = State::kHoming};
    std::uint64_t newest = 0;
    const auto see = [&newest](const dds::Status& status) { newest = status.status_sequence; };
    const auto is_ready = [](State state) { return state == State::kReady; };
    const bool is_reached = link_.wait_for_state(reply, is_ready, see, kPatience).has_value();
    is_over = true;
    service.join();
    return is_reached ? newest : 0;
  }

  static constexpr milliseconds kPatience{5000};

  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = "m"}};
  dds::Writer<dds::Status> statuses_{participant_};
  OperatorLink link_{participant_, "test"};
  std::uint64_t sequence_ = 0;
};

TEST_F(OperatorWhoWaits, TakesNoStatusOfBeforeForTheEffectHoweverLateItComes) {
  show(State::kReady);
  ASSERT_TRUE(link_.wait_for_status(kPatience));
  // The first was made before the verb took effect.
  EXPECT_GE(wait_for_ready({State::kReady, State::kHoming, State::kReady}), 4U);
}

TEST_F(OperatorWhoWaits, MissesNoEffectThatWasOverBeforeAStatusSaidSo) {
  show(State::kReady);
  ASSERT_TRUE(link_.wait_for_status(kPatience));
  EXPECT_GE(wait_for_ready({State::kReady}), 3U);
}

}  // namespace
}  // namespace meridian::stream
