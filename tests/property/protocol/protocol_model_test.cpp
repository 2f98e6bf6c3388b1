// SPDX-License-Identifier: Apache-2.0
#include "property/protocol/protocol_model.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace meridian::stream {
namespace {

[[nodiscard]] test::Exploration check(Variant variant, const Bounds& bounds) {
  static const MachineModel model = test::lai_machine();
  const test::Exploration found = test::explore<Protocol>(
      Protocol(model, variant, bounds), [](const Protocol& p) { return p.steps(); },
      [](const Protocol& p) { return p.key(); }, [](const Protocol& p) { return p.complaint(); },
      2'000'000);
  std::printf("%zu states, %zu steps%s\n", found.states, found.steps,
              found.complaint.empty() ? "" : (": " + found.text()).c_str());
  return found;
}

TEST(ProtocolModel, LosesNothingAndRunsNothingTwiceWhateverTheWireDoes) {
  const auto found = check(Variant::kRight, {.to_station = 2});
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.complaint, "") << found.text();
}

TEST(ProtocolModel, SurvivesAStationThatIsReplaced) {
  const auto found = check(Variant::kRight, {.to_service = 1, .station_restarts = 1});
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.complaint, "") << found.text();
}

TEST(ProtocolModel, SurvivesAServiceThatIsRestarted) {
  const auto found = check(Variant::kRight, {.to_service = 1, .service_restarts = 1});
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.complaint, "") << found.text();
}

TEST(ProtocolModel, SurvivesAnAbort) {
  const auto found = check(Variant::kRight, {.aborts = 1});
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.complaint, "") << found.text();
}

TEST(ProtocolModel, CatchesAServiceThatGrantsPlacesThatItHasNot) {
  EXPECT_EQ(check(Variant::kCountsSlotsTwice, {.blocks = 4}).complaint, "more blocks than places");
}

TEST(ProtocolModel, CatchesAServiceThatTrustsTheWire) {
  EXPECT_EQ(check(Variant::kTrustsTheWire, {}).complaint, "a spoilt block got through");
}

TEST(ProtocolModel, CatchesAServiceThatTakesDuplicates) {
  EXPECT_EQ(check(Variant::kRunsDuplicates, {}).complaint, "a block is missing or comes twice");
}

}  // namespace
}  // namespace meridian::stream
