// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#pragma once

#include <stdint.h>
#include <string.h>

/// What `meridian-hal` and the component `meridian_hal` of LinuxCNC's HAL share: a page of memory,
/// each side writing a part of its own under a sequence lock. No side ever waits for the other.
/// Units: mm or rad, and s; times are of CLOCK_MONOTONIC. For C and C++.
#ifdef __cplusplus
extern "C" {
#endif

#define MERIDIAN_HAL_FILE "/meridian-hal-"  // and the name of the machine: POSIX shared memory
#define MERIDIAN_HAL_MAGIC 0x4D484C34u      // "MHL4": another layout, another magic
#define MERIDIAN_HAL_JOINTS 6
#define MERIDIAN_HAL_KEPT 64  // setpoints that the component can look back on, after a stall too

/// Written once, before `magic`.
struct meridian_hal_setup {
  uint32_t magic;
  uint32_t joints;
  int64_t period_ns;     // of the setpoints
  int64_t bridge_ns;     // setpoints may stay away for so long
  uint32_t rotary_mask;  // joints that HAL has in degrees, the others in mm
  uint32_t reserved;
  double fault_acceleration[MERIDIAN_HAL_JOINTS];
};

enum meridian_hal_action {
  MERIDIAN_HAL_NO_ACTION,  // the process gave an order up: everything off
  MERIDIAN_HAL_SPINDLE_OFF,
  MERIDIAN_HAL_SPINDLE_CLOCKWISE,         // value: rev/min
  MERIDIAN_HAL_SPINDLE_COUNTERCLOCKWISE,  // value: rev/min
  MERIDIAN_HAL_COOLANT_OFF,
  MERIDIAN_HAL_COOLANT_MIST,
  MERIDIAN_HAL_COOLANT_FLOOD,
  MERIDIAN_HAL_TOOL_CHANGE  // value: tool number
};

enum meridian_hal_order_result {
  MERIDIAN_HAL_ORDER_DONE = 1,
  MERIDIAN_HAL_ORDER_FAILED  // stopped, or given to a component that is gone: it never runs again
};

/// One period of the process: where the joints are to be at its end.
struct meridian_hal_setpoint {
  uint64_t number;  // counts, from 1
  int64_t end_ns;   // of the period
  double position[MERIDIAN_HAL_JOINTS];
  double velocity[MERIDIAN_HAL_JOINTS];
  uint32_t on_mask;      // power stage on
  uint32_t homing_mask;  // HAL is to find the reference
  uint32_t index_mask;   // HAL is to catch the index pulse
  uint32_t reset_mask;   // the operator resets a fault
};

struct meridian_hal_order {
  uint64_t number;  // counts, from 1; 0: none yet
  uint32_t action;  // enum meridian_hal_action
  uint32_t reserved;
  double value;
};

/// One period of HAL's servo thread.
struct meridian_hal_report {
  uint64_t number;
  int64_t time_ns;
  double position[MERIDIAN_HAL_JOINTS];
  double index_position[MERIDIAN_HAL_JOINTS];  // of the newest pulse
  uint32_t index_count[MERIDIAN_HAL_JOINTS];   // pulses so far
  uint32_t fault_mask;                         // amplifier faults
  uint32_t homed_mask;
  uint32_t is_stopped;     // the emergency stop chain is open
  uint32_t is_lost;        // setpoints stayed away: ramped down and off
  uint64_t order_over;     // number of the newest order that is over
  uint32_t order_result;   // its enum meridian_hal_order_result
  uint32_t probe;          // 0 none connected, 1 free, 2 in contact
  uint32_t is_guard_open;  // of the work space
  uint32_t reserved;
};

/// The parts that are guarded, each by the lock in front of it: odd while it is written.
struct meridian_hal_shared {
  struct meridian_hal_setup setup;
  uint32_t setpoint_lock;
  uint32_t order_lock;
  uint32_t report_lock;
  uint32_t reserved;
  struct meridian_hal_setpoint setpoints[MERIDIAN_HAL_KEPT];  // place: number % MERIDIAN_HAL_KEPT
  struct meridian_hal_order order;
  struct meridian_hal_report report;
};

/// Memory order: the reader's first load of the lock acquires what was released with it, the fence
/// keeps its copy in front of the second load; the writer's fence keeps its stores behind the odd
/// value. One writer for each part. Proof: tests/unit/hal/shared_test.cpp.
static inline void meridian_hal_write(uint32_t* lock, void* part, const void* value,
                                      size_t bytes) {
  const uint32_t before = __atomic_load_n(lock, __ATOMIC_RELAXED) | 1u;
  __atomic_store_n(lock, before, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  memcpy(part, value, bytes);
  __atomic_store_n(lock, before + 1, __ATOMIC_RELEASE);
}

/// 0: `value` is torn, the writer was at it each of the four times (or died there); keep the last.
static inline int meridian_hal_read(const uint32_t* lock, const void* part, void* value,
                                    size_t bytes) {
  for (int tries = 0; tries < 4; ++tries) {
    const uint32_t before = __atomic_load_n(lock, __ATOMIC_ACQUIRE);
    if ((before & 1u) != 0) continue;
    memcpy(value, part, bytes);
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (__atomic_load_n(lock, __ATOMIC_RELAXED) == before) return 1;
  }
  return 0;
}

#ifdef __cplusplus
}
#endif
