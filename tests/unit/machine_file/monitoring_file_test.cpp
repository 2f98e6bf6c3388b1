// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/monitoring_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "meridian/units.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

monitoring::Limits monitoring_of(const std::string& keys) {
  const MachineModel model = load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  const toml::table table = parse_text("[monitoring]\n" + keys, "lai.toml");
  Section file("lai.toml", table);
  return read_monitoring(file.section_or("monitoring"), model);
}

std::string refusal_of_monitoring(const std::string& keys) {
  try {
    (void)parse_machine(test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml") +
                            "\n[monitoring]\n" + keys,
                        "lai.toml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MonitoringFile, TakesFromTheJointsWhatItDoesNotSay) {
  const monitoring::Limits limits = monitoring_of("");
  EXPECT_EQ(limits.axis_count, 5);
  EXPECT_DOUBLE_EQ(limits.set_up_tip_speed, 2000.0 / 60) << "2 m/min";
  EXPECT_EQ(limits.axes[0].speed, 300);
  EXPECT_DOUBLE_EQ(limits.axes[0].standstill, 1) << "a fifth of its following error";
  EXPECT_DOUBLE_EQ(limits.axes[0].frozen, 5);
  EXPECT_DOUBLE_EQ(limits.axes[3].standstill, units::rad_from_deg(0.4));
  EXPECT_EQ(limits.axes[2].low, -500);
  EXPECT_EQ(limits.axes[2].set_up_high, 600);
  EXPECT_TRUE(limits.axes[3].has_window);
  EXPECT_FALSE(limits.axes[0].has_model) << "nobody said how the drives lag";
}

TEST(MonitoringFile, HasTheLimitsOfBothSidesOfAStage) {
  EXPECT_FALSE(monitoring_of("").has_stage);
  const std::string file = MERIDIAN_SOURCE_DIR "/deploy/machines/lai-hybrid.toml";
  const monitoring::Limits limits = load_monitoring(file, load_machine(file));
  EXPECT_TRUE(limits.has_stage);
  EXPECT_EQ(limits.axes[1].speed, 300) << "b2";
  EXPECT_EQ(limits.axes[1].drive_speed, 400) << "u1";
}

TEST(MonitoringFile, ReadsEveryKeyInItsUnit) {
  const monitoring::Limits limits = monitoring_of(
      "set_up_tip_mm_per_min = 1200\nset_up_linear_mm_per_min = 600\n"
      "set_up_rotary_deg_per_s = 5\nguard_stop_s = 1\nsettle_s = 0.2\n"
      "standstill_mm = 0.5\nstandstill_deg = 0.1\nfrozen_mm = 2\nfrozen_deg = 1\n"
      "window_low_mm_deg = [-1, -2, -3, -90, -5]\nwindow_high_mm_deg = [1, 2, 3, 90, 5]\n"
      "drive_time_constant_ms = [20, 20, 20, 30, 30]\ndrive_delay_cycles = 2\n"
      "model_error_mm = 0.3\nmodel_error_deg = 0.2\n");
  EXPECT_DOUBLE_EQ(limits.set_up_tip_speed, 20);
  EXPECT_DOUBLE_EQ(limits.axes[1].set_up_speed, 10);
  EXPECT_DOUBLE_EQ(limits.axes[4].set_up_speed, units::rad_from_deg(5));
  EXPECT_EQ(limits.guard_stop_s, 1);
  EXPECT_EQ(limits.settle_s, 0.2);
  EXPECT_EQ(limits.axes[0].standstill, 0.5);
  EXPECT_DOUBLE_EQ(limits.axes[3].frozen, units::rad_from_deg(1));
  EXPECT_DOUBLE_EQ(limits.axes[3].high, units::rad_from_deg(90));
  EXPECT_EQ(limits.axes[2].low, -3);
  EXPECT_EQ(limits.axes[2].set_up_low, -500) << "its travel";
  EXPECT_TRUE(limits.axes[3].has_model);
  EXPECT_DOUBLE_EQ(limits.axes[3].time_constant_s, 0.03);
  EXPECT_EQ(limits.axes[3].delay_cycles, 2);
  EXPECT_EQ(limits.axes[0].model_error, 0.3);
}

TEST(MonitoringFile, RefusesWhatMeansNothingAndSaysWhy) {
  const struct {
    const char* keys;
    const char* reason;
  } kCases[] = {
      {"standstil_mm = 1\n", "standstill_mm"},
      {"standstill_mm = 0\n", "standstill_mm"},
      {"window_low_mm_deg = [0, 0, 0, 0, 0]\n", "both ends"},
      {"window_low_mm_deg = [0, 0, 0]\nwindow_high_mm_deg = [1, 1, 1]\n", "machine order"},
      {"window_low_mm_deg = [0, 0, 0, 0, 0]\nwindow_high_mm_deg = [0, 1, 1, 1, 1]\n", "below"},
      {"drive_time_constant_ms = [1]\n", "machine order"},
      {"set_up_tip_mm_per_min = -3\n", "set_up_tip_mm_per_min"},
  };
  for (const auto& one : kCases) {
    EXPECT_NE(refusal_of_monitoring(one.keys).find(one.reason), std::string::npos)
        << one.keys << refusal_of_monitoring(one.keys);
  }
}

}  // namespace
}  // namespace meridian::config
