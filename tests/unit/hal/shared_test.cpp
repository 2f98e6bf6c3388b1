// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/shared.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace {

TEST(HalShared, AReaderNeverSeesHalfOfTwoSetpoints) {
  static meridian_hal_shared shared;
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    meridian_hal_setpoint one{};
    while (!is_over) {
      ++one.number;
      for (double& value : one.position) value = static_cast<double>(one.number);
      meridian_hal_write(&shared.setpoint_lock, &shared.setpoints[0], &one, sizeof one);
      std::this_thread::yield();
    }
  });
  int seen = 0;
  meridian_hal_setpoint one{};
  for (int n = 0; n < 20'000; ++n) {
    if (meridian_hal_read(&shared.setpoint_lock, &shared.setpoints[0], &one, sizeof one) == 0) {
      continue;
    }
    ++seen;
    for (const double value : one.position) ASSERT_EQ(value, static_cast<double>(one.number));
  }
  is_over = true;
  writer.join();
  EXPECT_GT(seen, 1000);
}

TEST(HalShared, AWriterThatDiedInTheMiddleIsNotReadAndTheNextOneMends) {
  meridian_hal_shared shared{};
  shared.order_lock = 7;  // odd
  meridian_hal_order order{};
  EXPECT_EQ(meridian_hal_read(&shared.order_lock, &shared.order, &order, sizeof order), 0);
  order.number = 3;
  meridian_hal_write(&shared.order_lock, &shared.order, &order, sizeof order);
  order.number = 0;
  EXPECT_EQ(meridian_hal_read(&shared.order_lock, &shared.order, &order, sizeof order), 1);
  EXPECT_EQ(order.number, 3U);
}

}  // namespace
