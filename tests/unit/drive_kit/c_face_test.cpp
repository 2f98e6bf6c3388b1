// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

#include "support/private_domain.hpp"
#include "unit/drive_kit/c_program.h"
#include "unit/drive_kit/wire_service.hpp"

namespace meridian {
namespace {

using OpenDrives = std::unique_ptr<meridian_drives, decltype(&meridian_drives_close)>;

/// A program in C and a service on the wire.
class CFace : public testing::Test {
 protected:
  CFace() {
    char why[256] = "";
    drives_.reset(open_c_drives(&motors_, domain_.id(), why, sizeof why));
    EXPECT_TRUE(drives_) << why;
    thread_ = std::thread([this] {
      while (!is_stopping_) {
        meridian_drives_work(drives_.get(), 1);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~CFace() override { stop(); }
  void stop() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

  const support::PrivateDomain domain_;
  c_motors motors_{};
  OpenDrives drives_{nullptr, &meridian_drives_close};
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

TEST_F(CFace, MotorsInCFollowAService) {
  test::WireService service({.domain = domain_.id(), .machine = "c_mill"});
  ASSERT_TRUE(service.enable());
  EXPECT_EQ(service.feedback.joint_mask, 1U);
  EXPECT_EQ(service.feedback.referenced_mask, 0U);
  for (int n = 0; n < 100; ++n) service.period(0x0F, 0.01 * n, kSetpointEnabled);
  for (int n = 0; n < 50; ++n) service.period(0x0F, 0.99, kSetpointEnabled);
  EXPECT_NEAR(service.feedback.position[0], 0.99, 1e-9);
  EXPECT_EQ(meridian_drives_axis_count(drives_.get()), 1);
  EXPECT_EQ(meridian_drives_cycle_ns(drives_.get()), 1'000'000);
  stop();
  EXPECT_GT(motors_.elapsed_s, 0.1) << "150 cycles were commanded";
  EXPECT_LT(motors_.elapsed_s, 1);
}

TEST(CFaceAtTheStart, WhatIsWrongIsSaidInWords) {
  char why[256] = "";
  EXPECT_EQ(meridian_drives_open(nullptr, nullptr, why, sizeof why), nullptr);
  EXPECT_NE(std::strstr(why, "required"), nullptr) << why;
  c_motors motors{};
  const meridian_drive_hardware hardware = c_hardware(&motors);
  meridian_drive_options options{};
  EXPECT_EQ(meridian_drives_open(&options, &hardware, why, sizeof why), nullptr);
  EXPECT_NE(std::strstr(why, "no machine"), nullptr) << why;
}

TEST(CFaceAtTheStart, RunEndsWhereItsFlagIsSet) {
  const support::PrivateDomain domain;
  c_motors motors{};
  motors.stops_after = 50;
  char why[256] = "";
  const OpenDrives drives(open_c_drives(&motors, domain.id(), why, sizeof why),
                          &meridian_drives_close);
  ASSERT_TRUE(drives) << why;
  meridian_drives_run(drives.get(), &motors.is_stopping);
  EXPECT_EQ(motors.periods, 50);
  EXPECT_STREQ(meridian_drives_status(drives.get(), 0).state, "switch on disabled");
  for (const int axis : {-1, 1}) {
    EXPECT_STREQ(meridian_drives_status(drives.get(), axis).state, "") << "there is no such axis";
  }
}

}  // namespace
}  // namespace meridian
