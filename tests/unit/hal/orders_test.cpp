// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/component/orders.h"

#include <gtest/gtest.h>

namespace {

/// The process' side is played by the test; HAL's inputs are what it says.
class HalOrders : public testing::Test {
 protected:
  HalOrders() { step(); }
  void order(meridian_hal_action action, double value = 0) {
    meridian_hal_order one{};
    one.number = ++number_;
    one.action = action;
    one.value = value;
    meridian_hal_write(&shared_.order_lock, &shared_.order, &one, sizeof one);
  }
  void step() { meridian_hal_orders_step(&orders_, &shared_, &in_); }
  /// HAL starts again; the memory stays.
  void load_again() {
    orders_ = {};
    step();
  }
  void stop_and_go_on() {
    in_.is_stopped = 1;
    step();
    EXPECT_TRUE(is_all_off());
    in_.is_stopped = 0;
    for (int n = 0; n < 3; ++n) step();
  }
  [[nodiscard]] bool is_all_off() const {
    const meridian_hal_order_outputs& out = orders_.out;
    return out.turn == MERIDIAN_HAL_STANDS && out.spindle_speed == 0 && out.mist == 0 &&
           out.flood == 0 && out.tool_prepare == 0 && out.tool_change == 0;
  }
  [[nodiscard]] bool is_over(meridian_hal_order_result result) const {
    return meridian_hal_order_over(&orders_) == number_ && orders_.result == result;
  }

  meridian_hal_shared shared_{};
  meridian_hal_orders orders_{};
  meridian_hal_order_inputs in_{
      .is_stopped = 0, .is_at_speed = 1, .is_tool_prepared = 0, .is_tool_changed = 0};
  std::uint64_t number_ = 0;
};

TEST_F(HalOrders, TheSpindleTurnsAsOrderedAndTheOrderIsDoneAtItsSpeed) {
  in_.is_at_speed = 0;
  order(MERIDIAN_HAL_SPINDLE_CLOCKWISE, 8000);
  step();
  EXPECT_EQ(orders_.out.turn, MERIDIAN_HAL_TURNS_FORWARD);
  EXPECT_EQ(orders_.out.spindle_speed, 8000);
  EXPECT_FALSE(is_over(MERIDIAN_HAL_ORDER_DONE));
  in_.is_at_speed = 1;
  step();
  EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_DONE));
  order(MERIDIAN_HAL_SPINDLE_COUNTERCLOCKWISE, 500);
  step();
  EXPECT_EQ(orders_.out.turn, MERIDIAN_HAL_TURNS_REVERSE);
  EXPECT_EQ(orders_.out.spindle_speed, -500);
  order(MERIDIAN_HAL_SPINDLE_OFF);
  step();
  EXPECT_TRUE(is_all_off());
  EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_DONE));
}

TEST_F(HalOrders, MistAndFloodAddUpUntilCoolantOff) {
  order(MERIDIAN_HAL_COOLANT_MIST);
  step();
  order(MERIDIAN_HAL_COOLANT_FLOOD);
  step();
  EXPECT_EQ(orders_.out.mist, 1);
  EXPECT_EQ(orders_.out.flood, 1);
  order(MERIDIAN_HAL_COOLANT_OFF);
  step();
  EXPECT_TRUE(is_all_off());
}

TEST_F(HalOrders, AToolIsPreparedThenChangedAsInIocontrol) {
  order(MERIDIAN_HAL_TOOL_CHANGE, 7);
  step();
  EXPECT_EQ(orders_.out.tool_prep_number, 7);
  EXPECT_EQ(orders_.out.tool_prepare, 1);
  EXPECT_EQ(orders_.out.tool_change, 0);
  in_.is_tool_prepared = 1;
  step();
  EXPECT_EQ(orders_.out.tool_prepare, 0);
  EXPECT_EQ(orders_.out.tool_change, 1);
  EXPECT_EQ(orders_.out.tool_number, 0) << "not before the changer says so";
  in_.is_tool_changed = 1;
  step();
  EXPECT_EQ(orders_.out.tool_number, 7);
  EXPECT_EQ(orders_.out.tool_change, 0);
  EXPECT_FALSE(is_over(MERIDIAN_HAL_ORDER_DONE));
  in_.is_tool_changed = 0;
  step();
  EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_DONE));
}

TEST_F(HalOrders, TheOrderThatStandsInTheMemoryIsNotRunByAnotherComponent) {
  for (const auto action :
       {MERIDIAN_HAL_SPINDLE_CLOCKWISE, MERIDIAN_HAL_SPINDLE_COUNTERCLOCKWISE,
        MERIDIAN_HAL_COOLANT_MIST, MERIDIAN_HAL_COOLANT_FLOOD, MERIDIAN_HAL_TOOL_CHANGE}) {
    order(action, 8000);
    step();
    load_again();
    EXPECT_TRUE(is_all_off()) << action;
    EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_FAILED)) << "whoever waits for it hears that";
    for (int n = 0; n < 3; ++n) step();
    EXPECT_TRUE(is_all_off()) << action;
  }
  order(MERIDIAN_HAL_SPINDLE_CLOCKWISE, 100);
  step();
  EXPECT_EQ(orders_.out.spindle_speed, 100) << "the next one is";
}

TEST_F(HalOrders, ASpindleThatWasStoppedInItsRunUpDoesNotStartAgainByItself) {
  in_.is_at_speed = 0;
  order(MERIDIAN_HAL_SPINDLE_CLOCKWISE, 8000);
  step();
  stop_and_go_on();
  EXPECT_TRUE(is_all_off());
  EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_FAILED));
}

TEST_F(HalOrders, AToolChangeThatWasStoppedAtAnyStepIsOver) {
  for (int steps = 1; steps <= 3; ++steps) {
    in_.is_tool_prepared = in_.is_tool_changed = 0;
    order(MERIDIAN_HAL_TOOL_CHANGE, 7);
    for (int n = 0; n < steps; ++n) {
      in_.is_tool_prepared = n > 0;
      in_.is_tool_changed = n > 1;
      step();
    }
    stop_and_go_on();
    EXPECT_TRUE(is_all_off()) << steps;
    EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_FAILED)) << steps;
  }
}

TEST_F(HalOrders, AnOrderThatComesWhileTheMachineIsStoppedHasFailed) {
  in_.is_stopped = 1;
  order(MERIDIAN_HAL_SPINDLE_CLOCKWISE, 8000);
  step();
  EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_FAILED));
  in_.is_stopped = 0;
  step();
  EXPECT_TRUE(is_all_off());
}

TEST_F(HalOrders, ATurningSpindleIsTakenAwayAndStaysOff) {
  order(MERIDIAN_HAL_SPINDLE_CLOCKWISE, 8000);
  step();
  order(MERIDIAN_HAL_COOLANT_FLOOD);
  step();
  stop_and_go_on();
  EXPECT_TRUE(is_all_off());
  EXPECT_TRUE(is_over(MERIDIAN_HAL_ORDER_DONE)) << "it was done before";
}

TEST_F(HalOrders, AnOrderThatTheProcessGaveUpLeavesNothingOn) {
  in_.is_at_speed = 0;
  order(MERIDIAN_HAL_SPINDLE_CLOCKWISE, 8000);
  step();
  order(MERIDIAN_HAL_NO_ACTION);
  step();
  EXPECT_TRUE(is_all_off());
  in_.is_at_speed = 1;
  step();
  EXPECT_TRUE(is_all_off());
}

TEST_F(HalOrders, AnOrderInPlaceOfAnUnfinishedToolChangeDropsItsPins) {
  order(MERIDIAN_HAL_TOOL_CHANGE, 7);
  step();
  in_.is_tool_prepared = 1;
  step();
  order(MERIDIAN_HAL_COOLANT_MIST);
  step();
  EXPECT_EQ(orders_.out.tool_change, 0);
  EXPECT_EQ(orders_.out.mist, 1);
}

}  // namespace
