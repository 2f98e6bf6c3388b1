// SPDX-License-Identifier: GPL-2.0-or-later
// Component of LinuxCNC's HAL: the drives of a Meridian machine as pins. It knows no DDS: the
// process `meridian-hal` speaks that, and both share a page of memory
// (service/drives/hal/shared.h).
//
//     loadrt meridian_hal machine=lai joints=5
//     addf meridian.update servo-thread
//
// Docs: docs/linuxcnc.md. Proof: tests/hal.
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// These need what stands before them.
// clang-format off
#include <rtapi.h>
#include <rtapi_app.h>
#include <hal.h>
// clang-format on

#include "service/drives/hal/component/follow.h"
#include "service/drives/hal/component/orders.h"

MODULE_LICENSE("GPL");
MODULE_DESCRIPTION("Drives of a Meridian machine");

static char* machine = 0;
RTAPI_MP_STRING(machine, "name of the machine, as its file has it");
static int joints = MERIDIAN_HAL_JOINTS;
RTAPI_MP_INT(joints, "joints of the machine");

struct joint_pins {
  hal_float_t *position, *velocity, *feedback;
  hal_bit_t *enable, *fault, *home_request, *homed, *index_enable;
};

struct pins {
  struct joint_pins joint[MERIDIAN_HAL_JOINTS];
  hal_bit_t *emc_enable_in, *user_enable_out, *user_request_enable, *is_lost;
  hal_bit_t *probe_connected, *probe_contact, *guard_open;
  hal_bit_t *spindle_on, *spindle_forward, *spindle_reverse, *spindle_at_speed;
  hal_float_t* spindle_speed;
  hal_bit_t *coolant_mist, *coolant_flood;
  hal_bit_t *tool_prepare, *tool_prepared, *tool_change, *tool_changed;
  hal_s32_t *tool_prep_number, *tool_number;
};

static int component = -1;
static struct pins* pins = 0;
static struct meridian_hal_shared* shared = 0;
static struct meridian_hal_follow follow;
static struct meridian_hal_report report;
static struct meridian_hal_orders orders;
static int was_index_asked[MERIDIAN_HAL_JOINTS];
static double named_offset[MERIDIAN_HAL_JOINTS];  // what a reset at the index has renamed

static const double kDegree = 0.017453292519943295;

/// HAL counts rotary joints in degrees.
static double unit_of(const struct meridian_hal_setup* setup, int joint) {
  return (setup->rotary_mask >> joint & 1u) != 0 ? kDegree : 1;
}

static void report_drives(const struct meridian_hal_setup* setup, const double* feedback) {
  const struct meridian_hal_setpoint* const newest =
      &follow.kept[follow.newest % MERIDIAN_HAL_KEPT];
  for (int i = 0; i < joints; ++i) {
    struct joint_pins* const joint = &pins->joint[i];
    const int is_on =
        follow.phase[i] == MERIDIAN_HAL_FOLLOWS || follow.phase[i] == MERIDIAN_HAL_RAMPS;
    const double unit = unit_of(setup, i);
    *joint->position =
        (is_on ? follow.position[i] - named_offset[i] : feedback[i] - named_offset[i]) / unit;
    *joint->velocity = is_on ? follow.velocity[i] / unit : 0;
    *joint->enable = is_on && *pins->emc_enable_in;
    const int follows = follow.phase[i] == MERIDIAN_HAL_FOLLOWS;
    *joint->home_request = follows && (newest->homing_mask >> i & 1u) != 0;
    const int is_index_asked = follows && (newest->index_mask >> i & 1u) != 0;
    if (is_index_asked && !was_index_asked[i]) *joint->index_enable = 1;
    if (!is_index_asked) *joint->index_enable = 0;
    was_index_asked[i] = is_index_asked;
  }
}

/// An encoder that is reset at its index pulse drops index-enable: its count begins anew there. The
/// position goes on under its old name, the place of the pulse is where the new count is 0.
static void hear_index(int i, double raw, double moved_on) {
  struct joint_pins* const joint = &pins->joint[i];
  if (!was_index_asked[i] || *joint->index_enable) return;
  was_index_asked[i] = 0;
  const double before = report.position[i];
  named_offset[i] = before + moved_on - raw;
  report.index_position[i] = named_offset[i];
  ++report.index_count[i];
  *joint->index_enable = 0;
}

static void set_orders(void) {
  const struct meridian_hal_order_outputs* const out = &orders.out;
  *pins->spindle_forward = out->turn == MERIDIAN_HAL_TURNS_FORWARD;
  *pins->spindle_reverse = out->turn == MERIDIAN_HAL_TURNS_REVERSE;
  *pins->spindle_on = out->turn != MERIDIAN_HAL_STANDS;
  *pins->spindle_speed = out->spindle_speed;
  *pins->coolant_mist = out->mist;
  *pins->coolant_flood = out->flood;
  *pins->tool_prepare = out->tool_prepare;
  *pins->tool_change = out->tool_change;
  *pins->tool_prep_number = out->tool_prep_number;
  *pins->tool_number = out->tool_number;
}

static void work_orders(void) {
  const struct meridian_hal_order_inputs in = {
      .is_stopped = !*pins->emc_enable_in || report.is_lost,
      .is_at_speed = *pins->spindle_at_speed,
      .is_tool_prepared = *pins->tool_prepared,
      .is_tool_changed = *pins->tool_changed};
  meridian_hal_orders_step(&orders, shared, &in);
  set_orders();
}

/// The process is not up yet, or is of another version.
static void switch_off(void) {
  for (int i = 0; i < joints; ++i) {
    *pins->joint[i].enable = *pins->joint[i].home_request = *pins->joint[i].index_enable = 0;
    *pins->joint[i].velocity = 0;
    follow.phase[i] = MERIDIAN_HAL_LOST;
  }
  meridian_hal_orders_stop(&orders);
  orders.state = MERIDIAN_HAL_ORDERS_UNKNOWN;
  set_orders();
  *pins->is_lost = 1;
  *pins->user_enable_out = 0;
}

static void update(void* unused, long thread_ns) {
  (void)unused;
  const struct meridian_hal_setup setup = shared->setup;
  if (setup.magic != MERIDIAN_HAL_MAGIC) {
    switch_off();
    return;
  }
  const int64_t now_ns = rtapi_get_time();
  const double dt_s = 1e-9 * (double)meridian_hal_step_ns(&follow, now_ns, thread_ns);
  double feedback[MERIDIAN_HAL_JOINTS] = {0};
  report.fault_mask = report.homed_mask = 0;
  for (int i = 0; i < joints; ++i) {
    const double raw = *pins->joint[i].feedback * unit_of(&setup, i);
    hear_index(i, raw, follow.velocity[i] * dt_s);
    feedback[i] = raw + named_offset[i];
    if (*pins->joint[i].fault) report.fault_mask |= 1u << i;
    if (*pins->joint[i].homed) report.homed_mask |= 1u << i;
  }
  meridian_hal_step(&follow, shared, &setup, now_ns, thread_ns, feedback);
  report.is_lost = follow.is_silent != 0;
  for (int i = 0; i < joints; ++i) {
    const enum meridian_hal_phase phase = follow.phase[i];
    if (phase == MERIDIAN_HAL_LOST || phase == MERIDIAN_HAL_RAMPS) report.is_lost = 1;
  }
  report_drives(&setup, feedback);
  work_orders();
  *pins->is_lost = report.is_lost != 0;
  *pins->user_enable_out = follow.newest > 0 && !report.is_lost;
  const struct meridian_hal_setpoint* const newest =
      &follow.kept[follow.newest % MERIDIAN_HAL_KEPT];
  *pins->user_request_enable = newest->reset_mask != 0;
  report.order_over = meridian_hal_order_over(&orders);
  report.order_result = orders.result;
  ++report.number;
  report.time_ns = now_ns;
  report.is_stopped = !*pins->emc_enable_in;
  report.is_guard_open = *pins->guard_open;
  report.probe = !*pins->probe_connected ? 0 : *pins->probe_contact ? 2 : 1;
  memcpy(report.position, feedback, sizeof report.position);
  meridian_hal_write(&shared->report_lock, &shared->report, &report, sizeof report);
}

static int make_joint_pins(int i) {
  struct joint_pins* const joint = &pins->joint[i];
  int bad = 0;
  bad |= hal_pin_float_newf(HAL_OUT, &joint->position, component, "meridian.%d.pos-cmd", i);
  bad |= hal_pin_float_newf(HAL_OUT, &joint->velocity, component, "meridian.%d.vel-cmd", i);
  bad |= hal_pin_float_newf(HAL_IN, &joint->feedback, component, "meridian.%d.pos-fb", i);
  bad |= hal_pin_bit_newf(HAL_OUT, &joint->enable, component, "meridian.%d.amp-enable-out", i);
  bad |= hal_pin_bit_newf(HAL_IN, &joint->fault, component, "meridian.%d.amp-fault-in", i);
  bad |= hal_pin_bit_newf(HAL_OUT, &joint->home_request, component, "meridian.%d.home-request", i);
  bad |= hal_pin_bit_newf(HAL_IN, &joint->homed, component, "meridian.%d.homed", i);
  bad |= hal_pin_bit_newf(HAL_IO, &joint->index_enable, component, "meridian.%d.index-enable", i);
  return bad;
}

static int make_machine_pins(void) {
  struct {
    hal_bit_t** pin;
    hal_pin_dir_t direction;
    const char* name;
  } const bits[] = {{&pins->emc_enable_in, HAL_IN, "emc-enable-in"},
                    {&pins->user_enable_out, HAL_OUT, "user-enable-out"},
                    {&pins->user_request_enable, HAL_OUT, "user-request-enable"},
                    {&pins->is_lost, HAL_OUT, "setpoints-lost"},
                    {&pins->probe_connected, HAL_IN, "probe-connected"},
                    {&pins->probe_contact, HAL_IN, "probe-contact"},
                    {&pins->guard_open, HAL_IN, "guard-open"},
                    {&pins->spindle_on, HAL_OUT, "spindle-on"},
                    {&pins->spindle_forward, HAL_OUT, "spindle-forward"},
                    {&pins->spindle_reverse, HAL_OUT, "spindle-reverse"},
                    {&pins->spindle_at_speed, HAL_IN, "spindle-at-speed"},
                    {&pins->coolant_mist, HAL_OUT, "coolant-mist"},
                    {&pins->coolant_flood, HAL_OUT, "coolant-flood"},
                    {&pins->tool_prepare, HAL_OUT, "tool-prepare"},
                    {&pins->tool_prepared, HAL_IN, "tool-prepared"},
                    {&pins->tool_change, HAL_OUT, "tool-change"},
                    {&pins->tool_changed, HAL_IN, "tool-changed"}};
  int bad = 0;
  for (size_t i = 0; i < sizeof bits / sizeof bits[0]; ++i) {
    bad |= hal_pin_bit_newf(bits[i].direction, bits[i].pin, component, "meridian.%s", bits[i].name);
  }
  bad |= hal_pin_float_newf(HAL_OUT, &pins->spindle_speed, component, "meridian.spindle-speed-out");
  bad |= hal_pin_s32_newf(HAL_OUT, &pins->tool_prep_number, component, "meridian.tool-prep-number");
  bad |= hal_pin_s32_newf(HAL_OUT, &pins->tool_number, component, "meridian.tool-number");
  // What nobody connects must not stop the machine for good; the chain must.
  *pins->spindle_at_speed = 1;
  return bad;
}

static int map_memory(void) {
  char file[64];
  if (machine == 0 || strlen(machine) > 40) {
    rtapi_print_msg(RTAPI_MSG_ERR, "meridian_hal: machine=NAME is missing, or too long\n");
    return -1;
  }
  if (joints < 1 || joints > MERIDIAN_HAL_JOINTS) {
    rtapi_print_msg(RTAPI_MSG_ERR, "meridian_hal: joints=N must be from 1 to %d\n",
                    MERIDIAN_HAL_JOINTS);
    return -1;
  }
  rtapi_snprintf(file, sizeof file, "%s%s", MERIDIAN_HAL_FILE, machine);
  // Whoever comes first makes it; it is all zero then.
  const int handle = shm_open(file, O_RDWR | O_CREAT, 0600);
  if (handle < 0 || ftruncate(handle, sizeof *shared) != 0) {
    rtapi_print_msg(RTAPI_MSG_ERR, "meridian_hal: memory %s cannot be used: %s\n", file,
                    strerror(errno));
    if (handle >= 0) close(handle);
    return -1;
  }
  void* const memory = mmap(0, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, handle, 0);
  close(handle);
  if (memory == MAP_FAILED) {
    rtapi_print_msg(RTAPI_MSG_ERR, "meridian_hal: memory %s cannot be mapped\n", file);
    return -1;
  }
  shared = memory;
  return 0;
}

int rtapi_app_main(void) {
  component = hal_init("meridian_hal");
  if (component < 0) return component;
  pins = hal_malloc(sizeof *pins);
  int bad = pins == 0 || map_memory() != 0;
  for (int i = 0; !bad && i < joints; ++i) bad = make_joint_pins(i);
  if (!bad) bad = make_machine_pins();
  if (!bad) bad = hal_export_funct("meridian.update", update, 0, 1, 0, component);
  if (bad) {
    hal_exit(component);
    return -1;
  }
  return hal_ready(component);
}

void rtapi_app_exit(void) {
  hal_exit(component);
  if (shared != 0) munmap(shared, sizeof *shared);
}
