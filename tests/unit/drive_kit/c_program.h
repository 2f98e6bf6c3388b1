// SPDX-License-Identifier: Apache-2.0
#ifndef MERIDIAN_TEST_C_PROGRAM_H
#define MERIDIAN_TEST_C_PROGRAM_H

#include "meridian/drive.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Motors in C that stand at once where they are commanded. */
struct c_motors {
  double position[6];
  double elapsed_s; /* of axis 0 while it was on, by the service's clock */
  int periods, is_stop_open, is_guard_open, reports;
  int stops_after; /* periods; 0: never */
  meridian_probe probe;
  volatile int is_stopping;
  meridian_drive_output output[6];
};

meridian_drive_hardware c_hardware(struct c_motors* motors);
/* One linear axis "X" of machine "c_mill" in `domain`. */
meridian_drives* open_c_drives(struct c_motors* motors, uint32_t domain, char* why, size_t size);

#ifdef __cplusplus
}
#endif

#endif
