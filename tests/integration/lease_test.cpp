// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <string>

#include "integration/plant.hpp"

namespace meridian::test {
namespace {

TEST(Lease, RefusesTheLaterOfTwoServicesByName) {
  Plant plant;
  Process& first = plant.start_service();
  ASSERT_GT(plant.status().service_id, 0U) << first.said();
  const auto second = plant.another_service();
  EXPECT_EQ(second->wait(milliseconds(6000)), 1);
  const std::string said = second->said();
  EXPECT_NE(said.find("'lai' is served already"), std::string::npos) << said;
  EXPECT_NE(said.find("process " + std::to_string(first.pid())), std::string::npos) << said;
  EXPECT_FALSE(first.wait(milliseconds(200))) << "the first goes on: " << first.said();
}

TEST(Lease, LetsExactlyOneOfTwoThatStartTogetherServe) {
  Plant plant;
  Process& one = plant.start_service();
  const auto other = plant.another_service();
  const auto code_of_other = other->wait(milliseconds(4000));
  const auto code_of_one = one.wait(milliseconds(100));
  EXPECT_NE(code_of_other.has_value(), code_of_one.has_value()) << one.said() << "\n"
                                                                << other->said();
}

TEST(Lease, EndsTheLaterOfTwoServicesThatDidNotHearOfEachOtherInTime) {
  Plant plant;
  Process& first = plant.start_service();
  ASSERT_GT(plant.status().service_id, 0U) << first.said();
  first.send_signal(SIGSTOP);
  const auto second = plant.another_service();
  EXPECT_TRUE(
      eventually([&] { return second->said().find("answering in Off") != std::string::npos; },
                 milliseconds(6000)))
      << second->said();
  first.send_signal(SIGCONT);
  EXPECT_EQ(second->wait(milliseconds(6000)), 1);
  EXPECT_NE(second->said().find("'lai' is served already"), std::string::npos) << second->said();
  EXPECT_FALSE(first.wait(milliseconds(500))) << "the first goes on: " << first.said();
}

TEST(Lease, GivesTheMachineToANewServiceOnceAKilledOneIsForgotten) {
  Plant plant;
  Process& first = plant.start_service();
  const std::uint64_t first_id = plant.status().service_id;
  ASSERT_GT(first_id, 0U) << first.said();
  first.send_signal(SIGKILL);
  ASSERT_TRUE(first.wait(milliseconds(2000)));
  Process& second = plant.start_service();
  EXPECT_TRUE(eventually([&] { return plant.status().service_id != first_id; }, milliseconds(6000)))
      << second.said();
  EXPECT_EQ(plant.status().state, State::kOff);
}

}  // namespace
}  // namespace meridian::test
