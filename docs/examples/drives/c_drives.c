// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "meridian/drive.h"

static double position[6];  // your encoders
static volatile int is_stopping;

static void stop(int signal_number) { is_stopping = signal_number; }
static void read_axis(void* user, int axis, meridian_drive_reading* reading) {
  (void)user;
  reading->position = position[axis];
}
static void write_axis(void* user, int axis, const meridian_drive_output* output) {
  (void)user;
  if (output->is_on) position[axis] = output->position;  // your motors
}

// c_drives MACHINE [DOMAIN]: my_drives in C, without an action peer.
int main(int count, char** arguments) {
  const meridian_drive_hardware motors = {.read = read_axis, .write = write_axis};
  const meridian_drive_options options = {.machine_file = count > 1 ? arguments[1] : "lai.toml",
                                          .domain = count > 2 ? (uint32_t)atoi(arguments[2]) : 0};
  char why[256];
  meridian_drives* drives = meridian_drives_open(&options, &motors, why, sizeof why);
  if (drives == NULL) return fprintf(stderr, "%s\n", why), 1;
  signal(SIGINT, stop);
  signal(SIGTERM, stop);
  meridian_drives_run(drives, &is_stopping);
  meridian_drives_close(drives);
  return 0;
}
