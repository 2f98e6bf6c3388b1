// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdint>
#include <fstream>
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
  EXPECT_EQ(second->wait(milliseconds(10'000)), 1);
  EXPECT_NE(second->said().find("'lai' is served already"), std::string::npos) << second->said();
  EXPECT_FALSE(first.wait(milliseconds(500))) << "the first goes on: " << first.said();
}

/// As a service says it that waits for another one to leave the machine, which stands elsewhere.
dds::MachineInfo claim_like(const dds::MachineInfo& served, std::uint64_t service_id) {
  dds::MachineInfo claim = served;
  claim.service_id = service_id;
  claim.is_serving = false;
  claim.frame_origin_mm = {9000, 0, 0};
  return claim;
}

TEST(Lease, DoesNotShowAServiceThatOnlyWaitsForTheMachineToStationAndOperator) {
  Plant plant;
  Process& service = plant.start_service();
  ASSERT_GT(plant.status().service_id, 0U) << service.said();
  dds::Reader<dds::MachineInfo> machines(plant.participant());
  dds::MachineInfo served;
  ASSERT_TRUE(eventually([&] { return machines.take(served) && served.is_serving; }));
  dds::Writer<dds::MachineInfo> claims(plant.participant());
  ASSERT_TRUE(claims.write(claim_like(served, served.service_id - 1)));
  ASSERT_TRUE(claims.write(claim_like(served, served.service_id + 1)));

  Process status({"meridian", "status", "--json", "--domain", plant.domain()},
                 plant.folder() / "status.log");
  EXPECT_EQ(status.wait(milliseconds(10'000)), 0) << status.said();
  const std::string part = plant.folder() / "part.apt";
  std::ofstream(part) << "PARTNO/SHORT\nUNITS/MM\nFEDRAT/2000,MMPM\n"
                      << cl_text(small_program(4, 2000)) << "FINI\n";
  Process stream({"meridian", "stream", part, "--domain", plant.domain()},
                 plant.folder() / "stream.log");
  EXPECT_EQ(stream.wait(milliseconds(10'000)), 0) << stream.said();
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
