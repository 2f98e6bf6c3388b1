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

TEST(SceneLimits, ShowTheBoxesInForce) {
  MachineModel model =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  model.tip_box = {true, {-500, -500, -500}, {500, 500, 500}};
  KeepOutBox vice;
  vice.name = {"vice"};
  vice.joints = 0b101;
  vice.min = {1, 0, 3};
  vice.max = {2, 0, 4};
  ASSERT_TRUE(model.keep_out.add(vice));
  SoftLimits limits;
  vice.name = {"probe"};
  ASSERT_TRUE(limits.put(vice));
  limits.put(TipBox{true, {-1, -2, -3}, {1, 2, 3}});
  const json scene = json::parse(describe_scene(model, {}, limits));
  EXPECT_EQ(scene.at("tip_box"), json({{"min", {-1, -2, -3}}, {"max", {1, 2, 3}}}));
  ASSERT_EQ(scene.at("keep_out").size(), 2U);
  EXPECT_EQ(scene.at("keep_out")[1].at("name"), "probe");
  EXPECT_EQ(scene.at("keep_out")[0].at("joints")[1], json({{"joint", 2}, {"min", 3}, {"max", 4}}));
  EXPECT_EQ(json::parse(describe_scene(model, {})).at("tip_box").at("max"), json({500, 500, 500}));
}

}  // namespace
}  // namespace meridian::panel
