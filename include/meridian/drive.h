// SPDX-License-Identifier: Apache-2.0
#ifndef MERIDIAN_DRIVE_H
#define MERIDIAN_DRIVE_H

/* The C face of the library for drives: meridian/drive.hpp for programs in C and for everybody who
 * calls C (docs/drive-library.md). Link meridian::drive. Units: positions in mm or rad, velocities
 * per s, times in s; names that end in _ns are in ns.
 *
 * Errors: only meridian_drives_open() can fail, and says why. No function throws. What goes wrong
 * later is in the states of the axes, and is reported as text.
 *
 * Real time: functions marked "Real-time safe" make no heap call, take no lock, wait for nobody and
 * write no log.
 *
 * Threads: one thread works the drives and asks for their status; another may do so only when that
 * one has ended.
 *
 * Structures that you fill may be zero but for what is marked as required: zero means what it says
 * beside each member. */

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

/* What a search for the reference begins a period with. */
typedef struct meridian_homing_view {
  int is_begin;    /* 1: the first period of this search */
  double target;   /* to which the axis was led last */
  double position; /* where it stands */
  double dt_s;     /* length of the period */
} meridian_homing_view;

/* Where a search leads the axis. home() finds it filled: searching, the target as it was. */
typedef struct meridian_homing_step {
  meridian_homing_state state;
  double target;   /* MERIDIAN_HOMING_BY_CALLBACK: to be led to, before `shift` */
  double velocity; /* of the target */
  double shift;    /* added to what positions are called from now on; read() then adds it too */
} meridian_homing_step;

/* What the path waits for at rest. The texts are yours until act() returns. */
typedef struct meridian_drive_action {
  int kind;          /* meridian::drive::ActionKind, meridian/drive_action.hpp */
  double value;      /* rev/min, or the number of a tool */
  const char* text;  /* a word of the machine's builder, with its arguments */
  uint32_t line;     /* of the program */
  const char* words; /* for people: "spindle clockwise 8000 rev/min" */
} meridian_drive_action;

/* The motors. `read` and `write` are required, the others may be NULL. `axis` counts from 0. In
 * each period come write() of all axes, exchange(), read() of all axes, the inputs: on the thread
 * that works the drives, so they must be real-time safe as meridian_drives_work() is.
 * meridian_drives_open() calls read() and the inputs too. act() and report() have threads of their
 * own and may wait. */
typedef struct meridian_drive_hardware {
  void* user; /* the first argument of all of them; the library does not look at it */
  /* Where axis `axis` is; its own errors go into reading->error. */
  void (*read)(void* user, int axis, meridian_drive_reading* reading);
  /* What axis `axis` is to do. It cannot refuse: the next reading says that it has failed. */
  void (*write)(void* user, int axis, const meridian_drive_output* output);
  /* The cyclic frame of a fieldbus; dt_s: length of the period, of several where some were lost. */
  void (*exchange)(void* user, double dt_s);
  /* 1: the stop input is open. NULL: it is shut. */
  int (*is_emergency_stop)(void* user);
  /* One period of a search, MERIDIAN_HOMING_BY_DRIVE and BY_CALLBACK. NULL: it finds none. */
  void (*home)(void* user, int axis, const meridian_homing_view* view, meridian_homing_step* step);
  /* Does one action at a time. Returns 0 when it is done; else it is refused, and `why` (why_size
   * bytes, with the final 0) says the reason in words. NULL: somebody else does actions. */
  int (*act)(void* user, const meridian_drive_action* action, char* why, size_t why_size);
  /* News for the operator: states, actions, who was dropped. `text` is valid until it returns. */
  void (*report)(void* user, const char* text);
  /* The touch probe, of the same instant as the positions. NULL, or another value: none. */
  meridian_probe (*probe)(void* user);
  /* 1: a guard of the work space is open. NULL: it is shut. */
  int (*is_guard_open)(void* user);
} meridian_drive_hardware;

/* One axis in drive coordinates. Limits that are 0 are not checked. */
typedef struct meridian_drive_axis {
  const char* name;
  int joint; /* its place in drive order, from 0; each axis has its own */
  int is_rotary, is_endless;
  double travel_min, travel_max; /* not checked where they are equal */
  double velocity;
  double following_error;    /* largest distance of the position from the setpoint */
  double fault_acceleration; /* of the ramp after a fault; 0: it stands at once */
  meridian_homing_method homing;
  int is_unreferenced;    /* it does not know where it is at the start */
  double index_position;  /* BY_INDEX: what the place of the pulse is called */
  double search_velocity; /* BY_INDEX: with its sign; required there */
  double search_distance; /* BY_INDEX: the search fails after so much; 0: never */
} meridian_drive_axis;

/* Required: machine_file, or machine, axes and cycle_ns. Zero takes what the machine file says. */
typedef struct meridian_drive_options {
  const char* machine_file; /* TOML */
  const char* machine;      /* the machine's name: the DDS partition */
  const meridian_drive_axis* axes;
  int axis_count;       /* 0: all of the machine file */
  int64_t cycle_ns;     /* 50 000 to 100 000 000 */
  int machine_joints;   /* of the whole machine; without a machine file 0 is that of `axes` */
  int bridge_cycles;    /* until a service says how many; without a machine file 0 is 3 */
  uint32_t domain;      /* DDS domain */
  uint32_t group;       /* number of these drives, where several programs have some each */
  int priority;         /* SCHED_FIFO, where there is a right to it; 0: none. C++ begins with 65 */
  int may_leave_host;   /* 1: start though CYCLONEDDS_URI leads off the host unsecured */
  int is_beside_others; /* 1: start though somebody else reports these joints */
} meridian_drive_options;

/* How one axis is. */
typedef struct meridian_drive_status {
  uint16_t statusword;    /* CiA 402, object 6041h */
  uint16_t error;         /* object 603Fh; 0: none */
  const char* state;      /* as CiA 402 calls it; a constant of the library */
  double position;        /* mm or rad */
  double following_error; /* mm or rad */
  int is_referenced;
} meridian_drive_status;

/* Joins the wire, with drives that are off. Reads the axes; `options` and `hardware` are
 * copied, what `user` points to is not. Not real-time safe: it allocates, begins threads, and looks
 * for others who report these joints for 0.4 s. Error: returns NULL, and `why` (why_size bytes,
 * with the final 0; may be NULL) says what is wrong and how to mend it. */
meridian_drives* meridian_drives_open(const meridian_drive_options* options,
                                      const meridian_drive_hardware* hardware, char* why,
                                      size_t why_size);
/* Leaves the wire and frees `drives`; NULL is nothing. It does not stop motors: when it is called
 * with axes on, the last write() stands. No other call may run or follow. It waits for an act()
 * that runs. Not real-time safe. */
void meridian_drives_close(meridian_drives* drives);

/* One period: call it once per cycle time, always on one thread. `periods`: more than 1 where that
 * thread overslept some; less counts as 1. It has no error: what goes wrong is in the axes' states.
 * Real-time safe, as far as the functions of meridian_drive_hardware are. */
void meridian_drives_work(meridian_drives* drives, int periods);
/* Calls meridian_drives_work() once per cycle time, in phase, until *is_stopping is not 0; a signal
 * handler may set it. Lost periods are counted by itself. The thread has options.priority
 * meanwhile, where there is a right to it, and else goes on without: that is no error. Sleeps
 * between periods and is real-time safe otherwise. */
void meridian_drives_run(meridian_drives* drives, const volatile int* is_stopping);

/* How many axes there are: at least 1, the same for ever. Real-time safe, on any thread. */
int meridian_drives_axis_count(const meridian_drives* drives);
/* Cycle time in ns, the same for ever. Real-time safe, on any thread. */
int64_t meridian_drives_cycle_ns(const meridian_drives* drives);
/* How axis `axis` was in the newest period, for the thread that works the drives. Error: of an axis
 * that there is not all is 0, and `state` empty. Real-time safe. */
meridian_drive_status meridian_drives_status(const meridian_drives* drives, int axis);

#ifdef __cplusplus
}
#endif

#endif
