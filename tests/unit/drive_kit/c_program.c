// SPDX-License-Identifier: Apache-2.0
#include "unit/drive_kit/c_program.h"

#include <string.h>

static void read_axis(void* user, int axis, meridian_drive_reading* reading) {
  reading->position = ((struct c_motors*)user)->position[axis];
}

static void write_axis(void* user, int axis, const meridian_drive_output* output) {
  struct c_motors* motors = user;
  motors->output[axis] = *output;
  if (axis == 0 && output->is_on) motors->elapsed_s += output->elapsed_s;
  if (output->is_on) motors->position[axis] = output->position;
}

static void exchange(void* user, double dt_s) {
  struct c_motors* motors = user;
  (void)dt_s;
  if (++motors->periods == motors->stops_after) motors->is_stopping = 1;
}

static int is_emergency_stop(void* user) { return ((struct c_motors*)user)->is_stop_open; }

static meridian_probe probe(void* user) { return ((struct c_motors*)user)->probe; }

static int is_guard_open(void* user) { return ((struct c_motors*)user)->is_guard_open; }

static void home(void* user, int axis, const meridian_homing_view* view,
                 meridian_homing_step* step) {
  struct c_motors* motors = user;
  if (view->is_begin) return;
  step->state = MERIDIAN_HOMING_ATTAINED;
  step->shift = 100;
  motors->position[axis] += 100;
}

static int act(void* user, const meridian_drive_action* action, char* why, size_t size) {
  (void)user;
  if (action->value < 9000) return 0;
  strncpy(why, "too fast", size - 1);
  return 1;
}

static void report(void* user, const char* text) {
  ++((struct c_motors*)user)->reports;
  (void)text;
}

meridian_drive_hardware c_hardware(struct c_motors* motors) {
  const meridian_drive_hardware hardware = {
      motors, read_axis, write_axis, exchange, is_emergency_stop,
      home,   act,       report,     probe,    is_guard_open};
  return hardware;
}

meridian_drives* open_c_drives(struct c_motors* motors, uint32_t domain, char* why, size_t size) {
  meridian_drive_axis axis;
  meridian_drive_options options;
  const meridian_drive_hardware hardware = c_hardware(motors);
  memset(&axis, 0, sizeof axis);
  axis.name = "X";
  axis.velocity = 300;
  axis.following_error = 5;
  axis.fault_acceleration = 5000;
  axis.homing = MERIDIAN_HOMING_BY_CALLBACK;
  axis.is_unreferenced = 1;
  memset(&options, 0, sizeof options);
  options.machine = "c_mill";
  options.axes = &axis;
  options.axis_count = 1;
  options.machine_joints = 5;
  options.cycle_ns = 1000000;
  options.bridge_cycles = 100;
  options.domain = domain;
  return meridian_drives_open(&options, &hardware, why, size);
}
