// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#include "service/drives/hal/component/orders.h"

static void end(struct meridian_hal_orders* me, enum meridian_hal_order_result result) {
  me->state = MERIDIAN_HAL_ORDER_OVER;
  me->result = result;
}

static void turn(struct meridian_hal_orders* me, enum meridian_hal_turn turn) {
  const double speed = me->order.value;
  me->out.turn = turn;
  me->out.spindle_speed = turn == MERIDIAN_HAL_TURNS_FORWARD   ? speed
                          : turn == MERIDIAN_HAL_TURNS_REVERSE ? -speed
                                                               : 0;
}

static void leave_tool(struct meridian_hal_orders* me) {
  me->out.tool_prepare = me->out.tool_change = 0;
  me->tool_step = MERIDIAN_HAL_TOOL_IDLE;
}

void meridian_hal_orders_stop(struct meridian_hal_orders* me) {
  turn(me, MERIDIAN_HAL_STANDS);
  me->out.mist = me->out.flood = 0;
  leave_tool(me);
  if (me->state == MERIDIAN_HAL_ORDER_WORKS) end(me, MERIDIAN_HAL_ORDER_FAILED);
}

static int change_tool(struct meridian_hal_orders* me, const struct meridian_hal_order_inputs* in) {
  switch (me->tool_step) {
    case MERIDIAN_HAL_TOOL_IDLE:
      me->out.tool_prep_number = (int32_t)me->order.value;
      me->out.tool_prepare = 1;
      me->tool_step = MERIDIAN_HAL_TOOL_PREPARES;
      return 0;
    case MERIDIAN_HAL_TOOL_PREPARES:
      if (!in->is_tool_prepared) return 0;
      me->out.tool_prepare = 0;
      me->out.tool_change = 1;
      me->tool_step = MERIDIAN_HAL_TOOL_CHANGES;
      return 0;
    case MERIDIAN_HAL_TOOL_CHANGES:
      if (!in->is_tool_changed) return 0;
      me->out.tool_number = me->out.tool_prep_number;
      me->out.tool_change = 0;
      me->tool_step = MERIDIAN_HAL_TOOL_RELEASES;
      return 0;
    case MERIDIAN_HAL_TOOL_RELEASES:
      if (in->is_tool_changed) return 0;
      me->tool_step = MERIDIAN_HAL_TOOL_IDLE;
      return 1;
  }
  return 0;
}

/// 1: the order is done.
static int work(struct meridian_hal_orders* me, const struct meridian_hal_order_inputs* in) {
  switch (me->order.action) {
    case MERIDIAN_HAL_SPINDLE_OFF:
      turn(me, MERIDIAN_HAL_STANDS);
      return 1;
    case MERIDIAN_HAL_SPINDLE_CLOCKWISE:
      turn(me, MERIDIAN_HAL_TURNS_FORWARD);
      return in->is_at_speed;
    case MERIDIAN_HAL_SPINDLE_COUNTERCLOCKWISE:
      turn(me, MERIDIAN_HAL_TURNS_REVERSE);
      return in->is_at_speed;
    case MERIDIAN_HAL_COOLANT_OFF:
      me->out.mist = me->out.flood = 0;
      return 1;
    case MERIDIAN_HAL_COOLANT_MIST:
      me->out.mist = 1;
      return 1;
    case MERIDIAN_HAL_COOLANT_FLOOD:
      me->out.flood = 1;
      return 1;
    case MERIDIAN_HAL_TOOL_CHANGE:
      return change_tool(me, in);
    default:
      meridian_hal_orders_stop(me);
      return 0;
  }
}

static void read_order(struct meridian_hal_orders* me, const struct meridian_hal_shared* shared) {
  struct meridian_hal_order seen;
  if (!meridian_hal_read(&shared->order_lock, &shared->order, &seen, sizeof seen)) return;
  const int is_known = me->state != MERIDIAN_HAL_ORDERS_UNKNOWN;
  if (is_known && seen.number == me->order.number) return;
  me->order = seen;
  leave_tool(me);
  if (is_known) {
    me->state = MERIDIAN_HAL_ORDER_WORKS;
  } else {
    end(me, MERIDIAN_HAL_ORDER_FAILED);
  }
}

void meridian_hal_orders_step(struct meridian_hal_orders* me,
                              const struct meridian_hal_shared* shared,
                              const struct meridian_hal_order_inputs* in) {
  read_order(me, shared);
  if (in->is_stopped) {
    meridian_hal_orders_stop(me);
  } else if (me->state == MERIDIAN_HAL_ORDER_WORKS && work(me, in)) {
    end(me, MERIDIAN_HAL_ORDER_DONE);
  }
}

uint64_t meridian_hal_order_over(const struct meridian_hal_orders* me) {
  return me->state == MERIDIAN_HAL_ORDER_OVER ? me->order.number : 0;
}
