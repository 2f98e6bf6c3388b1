// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "service/machine/file/machine_file.hpp"
#include "service/panel/scene.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

TEST(SceneLimits, StandBesideTheTravelThatTheMachineIsDrawnBy) {
  const MachineModel model =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  SoftLimits limits;
  ASSERT_EQ(limits.apply({LimitsWord::kSet, 1, -20, 35.5}, model), LimitsFault::kNone);
  const json joints = json::parse(describe_scene(model, {}, limits)).at("joints");
  EXPECT_EQ(joints[1].at("soft_limits"), json({-20, 35.5}));
  EXPECT_EQ(joints[1].at("travel"),
            json({model.joints[1].limits.travel_min, model.joints[1].limits.travel_max}));
  EXPECT_FALSE(joints[0].contains("soft_limits"));
  EXPECT_FALSE(json::parse(describe_scene(model, {})).at("joints")[1].contains("soft_limits"));
}

}  // namespace
}  // namespace meridian::panel
