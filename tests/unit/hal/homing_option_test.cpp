// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/homing_option.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "meridian/drive.hpp"

namespace meridian::hal {
namespace {

class HomingOption : public testing::Test {
 protected:
  HomingOption() : axes_(2) {
    axes_[0].name = "X";
    axes_[1].name = "C";
    axes_[1].is_rotary = true;
  }
  [[nodiscard]] std::string refusal(const std::string& option) {
    try {
      set_homing(axes_, option);
    } catch (const drive::DriveError& error) {
      return error.what();
    }
    return "";
  }
  std::vector<drive::Axis> axes_;
};

TEST_F(HomingOption, HalSearches) {
  set_homing(axes_, "X=hal");
  EXPECT_EQ(axes_[0].homing.method, drive::HomingMethod::kByDrive);
  EXPECT_FALSE(axes_[0].homing.is_referenced);
  EXPECT_TRUE(axes_[1].homing.is_referenced) << "the other one is as it was";
}

TEST_F(HomingOption, ToTheIndexPulseInDegreesWhereTheAxisTurns) {
  set_homing(axes_, "C=index:-9:90:360");
  const drive::HomingSpec& homing = axes_[1].homing;
  EXPECT_EQ(homing.method, drive::HomingMethod::kByIndex);
  EXPECT_DOUBLE_EQ(homing.search_velocity, -std::numbers::pi / 20);
  EXPECT_DOUBLE_EQ(homing.index_position, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(homing.search_distance, 2 * std::numbers::pi);
  set_homing(axes_, "X=index:5");
  EXPECT_EQ(axes_[0].homing.search_velocity, 5);
  EXPECT_EQ(axes_[0].homing.search_distance, 0);
}

TEST_F(HomingOption, RefusesWhatItDoesNotUnderstand) {
  EXPECT_NE(refusal("X").find("no '='"), std::string::npos);
  EXPECT_NE(refusal("Q=hal").find("no joint 'Q'"), std::string::npos);
  EXPECT_NE(refusal("X=switch").find("unknown method 'switch'"), std::string::npos);
  EXPECT_NE(refusal("X=index:fast").find("'fast' is no number"), std::string::npos);
  EXPECT_NE(refusal("X=index:nan").find("is no number"), std::string::npos);
  EXPECT_NE(refusal("X=index:1:2:3:4").find("one to three numbers"), std::string::npos);
}

}  // namespace
}  // namespace meridian::hal
