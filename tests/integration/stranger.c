// SPDX-License-Identifier: Apache-2.0
// stranger DOMAIN MACHINE HOW SERVICE_ID SECONDS: somebody in a machine's domain who commands its
// drives, written against idl/ and the C interface of Cyclone DDS alone. HOW:
//   forged  drive commands and setpoints that quote SERVICE_ID and lead drive 0 away at 3500 per s
//   master  enables the drives as their only service, holds them for 0.5 s, then as `forged`
//   jump    as `master`, then one setpoint 20 away
//   spoilt  as `master`, then setpoints whose checksum is wrong
//   hold    enables the drives as their only service, and stands
//   claim   a machine topic that says that it serves, for a year, with SERVICE_ID
// Prints what drive 0 reported at the begin and at the end: "drive 0 from X to Y".
#include <dds/dds.h>
#include <idl/drives.h>
#include <idl/status.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kDrives = 5 };

static dds_entity_t subscriber, publisher, participant;

static uint32_t crc32c(uint32_t crc, const void* data, size_t size) {
  const unsigned char* bytes = data;
  crc = ~crc;
  for (size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0x82F63B78U : 0);
  }
  return ~crc;
}

static dds_qos_t* qos_of(int is_reliable, int is_setpoint) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, is_reliable || is_setpoint ? 1 : 16);
  if (is_reliable) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  if (is_setpoint) {
    dds_qset_deadline(qos, DDS_MSECS(20));
    dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_MSECS(100));
  }
  return qos;
}

static dds_entity_t topic_of(const dds_topic_descriptor_t* type, const char* name) {
  return dds_create_topic(participant, type, name, NULL, NULL);
}

static dds_entity_t writer_of(const dds_topic_descriptor_t* type, const char* name, int is_reliable,
                              int is_setpoint) {
  dds_qos_t* qos = qos_of(is_reliable, is_setpoint);
  const dds_entity_t writer = dds_create_writer(publisher, topic_of(type, name), qos, NULL);
  dds_delete_qos(qos);
  return writer;
}

static void join(uint32_t id, const char* machine) {
  dds_create_domain(id, "file://" MERIDIAN_SOURCE_DIR "/deploy/cyclonedds-loopback.xml");
  participant = dds_create_participant(id, NULL, NULL);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_partition1(qos, machine);
  subscriber = dds_create_subscriber(participant, qos, NULL);
  publisher = dds_create_publisher(participant, qos, NULL);
  dds_delete_qos(qos);
}

// The newest report of the drives; 0: none came.
static int take_feedback(dds_entity_t reader, meridian_wire_Feedback* newest) {
  void* sample = newest;
  dds_sample_info_t info;
  int is_new = 0;
  while (dds_take(reader, &sample, &info, 1, 1) == 1) is_new |= info.valid_data;
  return is_new;
}

static void command_drives(dds_entity_t writer, uint64_t service, uint16_t controlword) {
  static uint64_t count = 0;
  meridian_wire_DriveCommand command = {0};
  command.service_id = service;
  command.mode = 8;
  command.controlword = controlword;
  for (unsigned drive = 0; drive < kDrives; ++drive) {
    command.drive = (uint8_t)drive;
    command.sample = ++count;
    dds_write(writer, &command);
  }
}

static void send_setpoint(dds_entity_t writer, uint64_t service, meridian_wire_Setpoint* setpoint,
                          int is_spoilt) {
  ++setpoint->cycle;
  setpoint->due_ns = (int64_t)dds_time();
  setpoint->flags = 1;
  setpoint->crc32c = crc32c(crc32c(0, &service, sizeof service), setpoint,
                            offsetof(meridian_wire_Setpoint, crc32c));
  if (is_spoilt) setpoint->crc32c ^= 1;
  dds_write(writer, setpoint);
}

static void claim(uint64_t service, double seconds) {
  const dds_entity_t writer = writer_of(&meridian_wire_Machine_desc, "meridian/machine", 1, 0);
  static meridian_wire_Machine machine;
  machine.service_id = service;
  machine.is_serving = 1;
  machine.served_ns = INT64_C(31536000000000000);
  for (double t = 0; t < seconds; t += 0.01) {
    dds_write(writer, &machine);
    dds_sleepfor(DDS_MSECS(10));
  }
}

static void attack(const char* how, uint64_t service, double seconds) {
  dds_qos_t* qos = qos_of(0, 0);
  dds_qset_deadline(qos, DDS_MSECS(20));
  const dds_entity_t reader = dds_create_reader(
      subscriber, topic_of(&meridian_wire_Feedback_desc, "meridian/feedback"), qos, NULL);
  dds_delete_qos(qos);
  const dds_entity_t setpoints = writer_of(&meridian_wire_Setpoint_desc, "meridian/setpoint", 0, 1);
  const dds_entity_t commands =
      writer_of(&meridian_wire_DriveCommand_desc, "meridian/drive_command", 1, 0);
  meridian_wire_Feedback feedback = {0};
  while (!take_feedback(reader, &feedback)) dds_sleepfor(DDS_MSECS(2));
  const double from = feedback.position[0];
  const int is_forged = strcmp(how, "forged") == 0, is_jump = strcmp(how, "jump") == 0;
  const int is_spoilt = strcmp(how, "spoilt") == 0, is_hold = strcmp(how, "hold") == 0;
  const double begins = is_forged ? 0 : 0.5;
  meridian_wire_Setpoint setpoint = {0};
  setpoint.cycle = (uint64_t)1 << 32;
  memcpy(setpoint.position, feedback.position, sizeof setpoint.position);
  for (double t = 0; t < seconds; t += 0.001) {
    const unsigned n = (unsigned)(t * 1000);
    // Shutdown, switch on, enable operation, each for as long as finding one another may take on a
    // busy host; who forges them begins anew again and again.
    const unsigned step = is_forged ? n % 15 : n;
    const unsigned ready = is_forged ? 5 : 200, on = is_forged ? 10 : 300;
    if (n % 5 == 0) command_drives(commands, service, step < ready ? 0x06 : step < on ? 0x07 : 0x0F);
    if (t >= begins && is_jump) setpoint.position[0] = from + 20;
    if (t >= begins && !is_jump && !is_spoilt && !is_hold) {
      setpoint.position[0] += 3.5;
      setpoint.velocity[0] = 3500;
    }
    send_setpoint(setpoints, service, &setpoint, is_spoilt && t >= begins);
    dds_sleepfor(DDS_MSECS(1));
  }
  take_feedback(reader, &feedback);
  printf("drive 0 from %.6f to %.6f\n", from, feedback.position[0]);
}

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const uint64_t service = strtoull(argv[4], NULL, 10);
  join((uint32_t)atoi(argv[1]), argv[2]);
  if (strcmp(argv[3], "claim") == 0) {
    claim(service, atof(argv[5]));
  } else {
    attack(argv[3], service, atof(argv[5]));
  }
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return 0;
}
