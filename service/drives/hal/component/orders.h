// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#pragma once

#include "service/drives/hal/shared.h"

/// Spindle, coolant and tool changer of the component, one order of the process at a time. Pure C
/// without HAL, for the component and its tests. No call allocates or waits.
/// Proof: tests/unit/hal/orders_test.cpp.
#ifdef __cplusplus
extern "C" {
#endif

/// Orders begin unknown: one that stands in the memory then was given to another component.
enum meridian_hal_order_state {
  MERIDIAN_HAL_ORDERS_UNKNOWN,
  MERIDIAN_HAL_ORDER_OVER,
  MERIDIAN_HAL_ORDER_WORKS
};

enum meridian_hal_tool_step {
  MERIDIAN_HAL_TOOL_IDLE,
  MERIDIAN_HAL_TOOL_PREPARES,
  MERIDIAN_HAL_TOOL_CHANGES,
  MERIDIAN_HAL_TOOL_RELEASES
};

enum meridian_hal_turn {
  MERIDIAN_HAL_STANDS,
  MERIDIAN_HAL_TURNS_FORWARD,
  MERIDIAN_HAL_TURNS_REVERSE
};

/// What HAL says in one period of its thread.
struct meridian_hal_order_inputs {
  int is_stopped;  // the chain is open, or setpoints stayed away
  int is_at_speed, is_tool_prepared, is_tool_changed;
};

/// The pins.
struct meridian_hal_order_outputs {
  enum meridian_hal_turn turn;
  double spindle_speed;  // rev/min, negative in reverse
  int mist, flood, tool_prepare, tool_change;
  int32_t tool_prep_number, tool_number;
};

struct meridian_hal_orders {
  enum meridian_hal_order_state state;
  enum meridian_hal_tool_step tool_step;
  struct meridian_hal_order order;        // the newest that was read
  enum meridian_hal_order_result result;  // of the newest that is over
  struct meridian_hal_order_outputs out;
};

/// Everything off; an order that works has failed and never runs again.
void meridian_hal_orders_stop(struct meridian_hal_orders* me);

/// One period of the servo thread. The order that stands in `shared` at the first one is not run.
void meridian_hal_orders_step(struct meridian_hal_orders* me,
                              const struct meridian_hal_shared* shared,
                              const struct meridian_hal_order_inputs* in);

/// Number of the newest order that is over; 0: none.
uint64_t meridian_hal_order_over(const struct meridian_hal_orders* me);

#ifdef __cplusplus
}
#endif
