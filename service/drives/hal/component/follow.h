// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#pragma once

#include "service/drives/hal/shared.h"

/// The motion of the hand-over: from setpoints of one period to positions of another. Pure C
/// without HAL, for the component and its tests. No call allocates or waits.
#ifdef __cplusplus
extern "C" {
#endif

/// A joint begins lost: what the process wants on at that moment was not meant for this component.
enum meridian_hal_phase {
  MERIDIAN_HAL_LOST,  // stands, off, until the process has said off
  MERIDIAN_HAL_OFF,   // not on: the position follows the feedback
  MERIDIAN_HAL_FOLLOWS,
  MERIDIAN_HAL_RAMPS  // setpoints stayed away: down by the fault acceleration
};

struct meridian_hal_follow {
  struct meridian_hal_setpoint incoming[MERIDIAN_HAL_KEPT];  // may be torn
  struct meridian_hal_setpoint kept[MERIDIAN_HAL_KEPT];      // copied whole
  uint64_t newest;                                           // number; 0: none
  enum meridian_hal_phase phase[MERIDIAN_HAL_JOINTS];
  double position[MERIDIAN_HAL_JOINTS];
  double velocity[MERIDIAN_HAL_JOINTS];
  int64_t called_ns;  // when the step before was
  int64_t time_ns;    // to which the joints are led
  int is_silent;      // no setpoint for longer than the bridge, whether joints are on or off
};

/// How far a call at `now_ns` leads on: the time since the call before, as measured, for HAL makes
/// up for lost periods by calls at once; after a stall two periods of the thread.
int64_t meridian_hal_step_ns(const struct meridian_hal_follow* me, int64_t now_ns,
                             int64_t thread_ns);

/// Leads `time_ns` on by that step. What a stall has left behind it catches up at nine eighths of
/// the pace at most: no position jumps, and the path is kept.
void meridian_hal_time(struct meridian_hal_follow* me, int64_t now_ns, int64_t thread_ns);

/// One period of the servo thread, which is `thread_ns` long, at `now_ns`. Positions are those of
/// one setpoint period ago: so each lies between two setpoints that are there, whatever the two
/// periods are, and none is more than one setpoint late. `feedback`: where the joints are.
void meridian_hal_step(struct meridian_hal_follow* me, const struct meridian_hal_shared* shared,
                       const struct meridian_hal_setup* setup, int64_t now_ns, int64_t thread_ns,
                       const double* feedback);

#ifdef __cplusplus
}
#endif
