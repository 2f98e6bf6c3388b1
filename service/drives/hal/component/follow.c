// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#include "service/drives/hal/component/follow.h"

static const struct meridian_hal_setpoint* kept(const struct meridian_hal_follow* me,
                                                uint64_t number) {
  const struct meridian_hal_setpoint* const found = &me->kept[number % MERIDIAN_HAL_KEPT];
  return number > 0 && found->number == number ? found : 0;
}

/// The first setpoint that ends at `at_ns` or later; 0: all end before it.
static const struct meridian_hal_setpoint* ends_after(const struct meridian_hal_follow* me,
                                                      int64_t at_ns) {
  const struct meridian_hal_setpoint* out = 0;
  for (uint64_t number = me->newest; number > 0 && number + MERIDIAN_HAL_KEPT > me->newest;
       --number) {
    const struct meridian_hal_setpoint* const one = kept(me, number);
    if (one == 0 || one->end_ns < at_ns) break;
    out = one;
  }
  return out;
}

/// Its on_mask holds at `at_ns`: a joint that is led late goes off where its path ends, not when
/// the process says so, which is ahead of it then.
static int is_wanted(const struct meridian_hal_setpoint* in_force, int joint) {
  return in_force != 0 && (in_force->on_mask >> joint & 1u) != 0;
}

/// The setpoints that come next at `at_ns` were overwritten by newer ones.
static int is_overtaken(const struct meridian_hal_follow* me, int64_t at_ns) {
  const struct meridian_hal_setpoint* const oldest =
      &me->kept[(me->newest + 1) % MERIDIAN_HAL_KEPT];
  return oldest->number > 0 && oldest->end_ns > at_ns;
}

static int is_led(const struct meridian_hal_follow* me) {
  for (int i = 0; i < MERIDIAN_HAL_JOINTS; ++i) {
    if (me->phase[i] == MERIDIAN_HAL_FOLLOWS || me->phase[i] == MERIDIAN_HAL_RAMPS) return 1;
  }
  return 0;
}

int64_t meridian_hal_step_ns(const struct meridian_hal_follow* me, int64_t now_ns,
                             int64_t thread_ns) {
  const int64_t measured = now_ns - me->called_ns, longest = 2 * thread_ns;
  return measured < longest ? measured : longest;
}

void meridian_hal_time(struct meridian_hal_follow* me, int64_t now_ns, int64_t thread_ns) {
  const int64_t step = meridian_hal_step_ns(me, now_ns, thread_ns);
  const int64_t late = is_led(me) ? now_ns - me->time_ns - step : 0;
  // Whatever has stalled for hours must not overflow the product.
  const int64_t catches_up = late < 8 * thread_ns ? late * step / (64 * thread_ns) : step / 8;
  me->called_ns = now_ns;
  me->time_ns = now_ns - late + catches_up;
}

/// The cubic through positions and velocities of both ends. Where it is farther from the straight
/// line than the largest acceleration bends a path, the velocities do not belong to the positions:
/// the straight line then.
static void between(const struct meridian_hal_setpoint* from,
                    const struct meridian_hal_setpoint* to, double acceleration, int64_t at_ns,
                    int joint, double* position, double* velocity) {
  const double length_s = 1e-9 * (double)(to->end_ns - from->end_ns);
  const double s = length_s > 0 ? 1e-9 * (double)(at_ns - from->end_ns) / length_s : 1;
  const double p0 = from->position[joint], distance = to->position[joint] - p0;
  const double v0 = from->velocity[joint] * length_s, v1 = to->velocity[joint] * length_s;
  const double curve = v0 + v1 - 2 * distance, steep = 3 * distance - 2 * v0 - v1;
  const double line = p0 + s * distance, cubic = p0 + s * (v0 + s * (steep + s * curve));
  const double off = cubic < line ? line - cubic : cubic - line;
  const int is_smooth = off <= acceleration * length_s * length_s / 8;
  *position = is_smooth ? cubic : line;
  const double slope = is_smooth ? v0 + s * (2 * steep + 3 * s * curve) : distance;
  *velocity = length_s > 0 ? slope / length_s : 0;
}

static void ramp_down(struct meridian_hal_follow* me, const struct meridian_hal_setup* setup,
                      int joint, double dt_s) {
  const double step = setup->fault_acceleration[joint] * dt_s;
  const double before = me->velocity[joint], speed = before < 0 ? -before : before;
  // Without an acceleration it stands at once.
  const double after = step > 0 && speed > step ? speed - step : 0;
  me->velocity[joint] = before < 0 ? -after : after;
  const double moving_s = speed > step ? dt_s : speed / setup->fault_acceleration[joint];
  if (step > 0) me->position[joint] += 0.5 * (before + me->velocity[joint]) * moving_s;
  if (after == 0) me->phase[joint] = MERIDIAN_HAL_LOST;
}

/// `to` is the first setpoint that ends at `at_ns` or later.
static void follow(struct meridian_hal_follow* me, const struct meridian_hal_setup* setup,
                   const struct meridian_hal_setpoint* to, int64_t at_ns, int joint) {
  const struct meridian_hal_setpoint* const from = kept(me, to->number - 1);
  if (!is_wanted(from, joint)) {  // it begins
    me->position[joint] = to->position[joint];
    me->velocity[joint] = to->velocity[joint];
    return;
  }
  between(from, to, setup->fault_acceleration[joint], at_ns, joint, &me->position[joint],
          &me->velocity[joint]);
}

/// Beyond the newest setpoint the joint goes on with its velocity: a late one is bridged, no jump.
static void bridge(struct meridian_hal_follow* me, const struct meridian_hal_setpoint* newest,
                   int64_t at_ns, int joint) {
  me->velocity[joint] = newest->velocity[joint];
  me->position[joint] =
      newest->position[joint] + newest->velocity[joint] * 1e-9 * (double)(at_ns - newest->end_ns);
}

static void read_setpoints(struct meridian_hal_follow* me,
                           const struct meridian_hal_shared* shared) {
  if (!meridian_hal_read(&shared->setpoint_lock, shared->setpoints, me->incoming,
                         sizeof me->incoming)) {
    return;
  }
  memcpy(me->kept, me->incoming, sizeof me->kept);
  for (int i = 0; i < MERIDIAN_HAL_KEPT; ++i) {
    if (me->kept[i].number > me->newest) me->newest = me->kept[i].number;
  }
}

void meridian_hal_step(struct meridian_hal_follow* me, const struct meridian_hal_shared* shared,
                       const struct meridian_hal_setup* setup, int64_t now_ns, int64_t thread_ns,
                       const double* feedback) {
  read_setpoints(me, shared);
  const double dt_s = 1e-9 * (double)meridian_hal_step_ns(me, now_ns, thread_ns);
  meridian_hal_time(me, now_ns, thread_ns);
  const struct meridian_hal_setpoint* const newest = kept(me, me->newest);
  const int64_t at_ns = me->time_ns - setup->period_ns;
  const struct meridian_hal_setpoint* const next = ends_after(me, at_ns);
  const struct meridian_hal_setpoint* const in_force = next != 0 ? next : newest;
  const int is_lost = newest == 0 || is_overtaken(me, at_ns) ||
                      now_ns - newest->end_ns > setup->bridge_ns + setup->period_ns;
  me->is_silent = is_lost;
  for (int i = 0; i < MERIDIAN_HAL_JOINTS; ++i) {
    const int is_on = is_wanted(in_force, i);
    switch (me->phase[i]) {
      case MERIDIAN_HAL_OFF:
        if (is_on && !is_lost) me->phase[i] = MERIDIAN_HAL_FOLLOWS;
        break;
      case MERIDIAN_HAL_FOLLOWS:
        if (!is_on) me->phase[i] = MERIDIAN_HAL_OFF;
        if (is_lost) me->phase[i] = MERIDIAN_HAL_RAMPS;
        break;
      case MERIDIAN_HAL_RAMPS:
        break;
      case MERIDIAN_HAL_LOST:
        if (!is_on && !is_lost) me->phase[i] = MERIDIAN_HAL_OFF;
        break;
    }
    switch (me->phase[i]) {
      case MERIDIAN_HAL_FOLLOWS:
        if (next == 0) {
          bridge(me, newest, at_ns, i);
        } else {
          follow(me, setup, next, at_ns, i);
        }
        break;
      case MERIDIAN_HAL_RAMPS:
        ramp_down(me, setup, i, dt_s);
        break;
      default:
        me->position[i] = feedback[i];
        me->velocity[i] = 0;
        break;
    }
  }
}
