// SPDX-License-Identifier: Apache-2.0
#ifndef MERIDIAN_DRIVE_H
#define MERIDIAN_DRIVE_H

/* The C face of the library for drives: meridian/drive.hpp for programs in C and for everybody who
 * calls C (docs/drive-library.md). Link meridian::drive. Units: mm or rad, and s. What is left zero
 * means what it means there; structures are initialised by the functions that say so. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct meridian_drives meridian_drives;

/* What one axis is to do until the next period. */
typedef struct meridian_drive_output {
  int is_on;       /* power stage on, brake released; 0: the brake holds */
  double position; /* to stand here at the end of the period */
  double velocity; /* of the position, for feed-forward */
  int is_homing;   /* MERIDIAN_HOMING_BY_DRIVE: the drive searches by itself */
  int is_reset;    /* the operator resets a fault: clear your own */
  /* From the position before to this one by the service's clock: setpoints come unevenly, two in
   * one period or none. Who interpolates goes by this, not by the period. */
  double elapsed_s;
} meridian_drive_output;

/* What one axis reports in one period. read() finds it filled with what most report: no velocity,
 * no error, power, ready, no index. */
typedef struct meridian_drive_reading {
  double position;
  double velocity; /* not a number: the library takes the difference of positions */
  uint16_t error;  /* CiA 402, object 603Fh; 0: no fault */
  int has_power;
  int is_ready;
  int is_index;
  double index_position;
} meridian_drive_reading;

/* What a touch probe says whose signal the drives read. */
typedef enum meridian_probe {
  MERIDIAN_PROBE_NONE = 0,
  MERIDIAN_PROBE_FREE = 1,
  MERIDIAN_PROBE_CONTACT = 2
} meridian_probe;

typedef enum meridian_homing_state {
  MERIDIAN_HOMING_SEARCHING = 0,
  MERIDIAN_HOMING_ATTAINED = 1,
  MERIDIAN_HOMING_FAILED = 2
} meridian_homing_state;

typedef enum meridian_homing_method {
  MERIDIAN_HOMING_NONE = 0,
  MERIDIAN_HOMING_BY_DRIVE = 1,
  MERIDIAN_HOMING_BY_INDEX = 2,
  MERIDIAN_HOMING_BY_CALLBACK = 3
} meridian_homing_method;

typedef struct meridian_homing_view {
  int is_begin;
  double target, position, dt_s;
} meridian_homing_view;

/* home() finds it filled: searching, the target as it was. */
typedef struct meridian_homing_step {
  meridian_homing_state state;
  double target, velocity, shift;
} meridian_homing_step;

typedef struct meridian_drive_action {
  int kind; /* meridian::drive::ActionKind */
  double value;
  const char* text;
  uint32_t line;
  const char* words;
} meridian_drive_action;

/* The motors. read and write are required, the others may be NULL. All but act and report are
 * called by the thread that works the drives, and may not wait; act is called on a thread of its
 * own and returns 0 when the action is done, else it has written why it is refused; report is
 * called on a thread of the library. */
typedef struct meridian_drive_hardware {
  void* user; /* the first argument of all of them */
  void (*read)(void* user, int axis, meridian_drive_reading* reading);
  void (*write)(void* user, int axis, const meridian_drive_output* output);
  void (*exchange)(void* user, double dt_s);
  int (*is_emergency_stop)(void* user);
  void (*home)(void* user, int axis, const meridian_homing_view* view, meridian_homing_step* step);
  int (*act)(void* user, const meridian_drive_action* action, char* why, size_t why_size);
  void (*report)(void* user, const char* text);
  meridian_probe (*probe)(void* user); /* of the same instant as the positions */
  int (*is_guard_open)(void* user);    /* a guard of the work space */
} meridian_drive_hardware;

typedef struct meridian_drive_axis {
  const char* name;
  int joint; /* its place in drive order, from 0 */
  int is_rotary, is_endless;
  double travel_min, travel_max, velocity, following_error, fault_acceleration;
  meridian_homing_method homing;
  int is_unreferenced; /* it does not know where it is at the start */
  double index_position, search_velocity, search_distance;
} meridian_drive_axis;

typedef struct meridian_drive_options {
  const char* machine_file; /* may be NULL where machine, axes and cycle_ns are given */
  const char* machine;      /* may be NULL */
  const meridian_drive_axis* axes;
  int axis_count; /* 0: all of the machine file */
  int64_t cycle_ns;
  int machine_joints, bridge_cycles;
  uint32_t domain, group;
  int priority; /* SCHED_FIFO; 0: none */
  int may_leave_host, is_beside_others;
} meridian_drive_options;

typedef struct meridian_drive_status {
  uint16_t statusword, error;
  const char* state;
  double position, following_error;
  int is_referenced;
} meridian_drive_status;

/* NULL: not started, and `why` says why and how to mend it. `options` and `hardware` are copied,
 * `user` is not. */
meridian_drives* meridian_drives_open(const meridian_drive_options* options,
                                      const meridian_drive_hardware* hardware, char* why,
                                      size_t why_size);
void meridian_drives_close(meridian_drives* drives);

/* One period, of several cycle times where the caller overslept; real-time safe. */
void meridian_drives_work(meridian_drives* drives, int periods);
/* Works once per cycle time until *is_stopping is not 0. A signal handler may set it. */
void meridian_drives_run(meridian_drives* drives, const volatile int* is_stopping);

int meridian_drives_axis_count(const meridian_drives* drives);
int64_t meridian_drives_cycle_ns(const meridian_drives* drives);
/* For the thread that works the drives. */
meridian_drive_status meridian_drives_status(const meridian_drives* drives, int axis);

#ifdef __cplusplus
}
#endif

#endif
