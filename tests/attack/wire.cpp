// SPDX-License-Identifier: Apache-2.0
#include "attack/wire.hpp"

#include <time.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace attack {
namespace {

template <class Sample>
constexpr Topic topic(const char* name, const dds_topic_descriptor_t& descriptor, Quality quality) {
  return {name, &descriptor, quality, sizeof(Sample)};
}

const std::array<Topic, 15> kTopics{{
    topic<meridian_wire_ClBatch>("cl_batch", meridian_wire_ClBatch_desc, Quality::kStream),
    topic<meridian_wire_ClSession>("cl_session", meridian_wire_ClSession_desc, Quality::kStream),
    topic<meridian_wire_ClCredit>("cl_credit", meridian_wire_ClCredit_desc, Quality::kStream),
    topic<meridian_wire_Command>("command", meridian_wire_Command_desc, Quality::kStream),
    topic<meridian_wire_Reply>("reply", meridian_wire_Reply_desc, Quality::kStream),
    topic<meridian_wire_Jog>("jog", meridian_wire_Jog_desc, Quality::kJog),
    topic<meridian_wire_Enabling>("enabling", meridian_wire_Enabling_desc, Quality::kJog),
    topic<meridian_wire_Setpoint>("setpoint", meridian_wire_Setpoint_desc, Quality::kSetpoint),
    topic<meridian_wire_DriveCommand>("drive_command", meridian_wire_DriveCommand_desc,
                                      Quality::kLatest),
    topic<meridian_wire_Feedback>("feedback", meridian_wire_Feedback_desc, Quality::kCyclic),
    topic<meridian_wire_Action>("action", meridian_wire_Action_desc, Quality::kStream),
    topic<meridian_wire_ActionDone>("action_done", meridian_wire_ActionDone_desc, Quality::kStream),
    topic<meridian_wire_Status>("status", meridian_wire_Status_desc, Quality::kLatest),
    topic<meridian_wire_Machine>("machine", meridian_wire_Machine_desc, Quality::kLatest),
    topic<meridian_wire_Latency>("latency", meridian_wire_Latency_desc, Quality::kSnapshot),
}};

enum class Side : std::uint8_t { kWriter, kReader };

/// Samples that a writer keeps for readers that have not acknowledged them: no write waits.
constexpr int kKept = 128;

/// As docs/topics.md says it, with the limits of whoever reads.
dds_qos_t* make_qos(Quality quality, Side side, const Limits& limits) {
  dds_qos_t* qos = dds_create_qos();
  const bool is_reliable =
      quality == Quality::kStream || quality == Quality::kLatest || quality == Quality::kSnapshot;
  dds_qset_reliability(qos, is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  const bool keeps_all = side == Side::kReader && quality == Quality::kStream;
  if (keeps_all || limits.max_samples > 0) {
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  } else {
    const int kept = quality == Quality::kStream ? kKept : 1;
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, std::max(kept, limits.depth));
  }
  if (limits.max_samples > 0) {
    dds_qset_resource_limits(qos, limits.max_samples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  if (quality == Quality::kLatest) {
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  if (quality == Quality::kCyclic || quality == Quality::kSetpoint) {
    dds_qset_deadline(qos, DDS_MSECS(20));
  }
  if (quality == Quality::kSetpoint) {
    dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_MSECS(100));
  }
  return qos;
}

dds_entity_t make_topic(dds_entity_t participant, const Topic& topic,
                        const dds_topic_descriptor_t& descriptor) {
  const std::string name = std::string("meridian/") + topic.name;
  return must(dds_create_topic(participant, &descriptor, name.c_str(), nullptr, nullptr),
              topic.name);
}

/// Once a process and domain: many participants, loopback alone.
void configure(int domain, double lease_s) {
  static std::once_flag once;
  std::call_once(once, [&] {
    char xml[900];
    std::snprintf(
        xml, sizeof xml,
        "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"lo\" "
        "multicast=\"false\"/></Interfaces><AllowMulticast>false</AllowMulticast></General>"
        "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>"
        "<Peers><Peer Address=\"127.0.0.1\"/></Peers><SPDPInterval>200 ms</SPDPInterval>"
        "<LeaseDuration>%.1f s</LeaseDuration></Discovery>"
        "<Sizing><ReceiveBufferSize>256 KiB</ReceiveBufferSize></Sizing>"
        "<Internal><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>"
        "</Domain></CycloneDDS>",
        lease_s);
    must(dds_create_domain(static_cast<dds_domainid_t>(domain), xml), "domain");
  });
}

}  // namespace

dds_entity_t must(dds_entity_t result, const char* what) {
  if (result >= 0) return result;
  std::fprintf(stderr, "attacker: %s: %s\n", what, dds_strretcode(-result));
  std::exit(1);
}

std::span<const Topic> topics() { return kTopics; }

const Topic& topic_named(std::string_view name) {
  for (const Topic& topic : kTopics) {
    if (topic.name == name) return topic;
  }
  std::fprintf(stderr, "attacker: no topic %s\n", std::string(name).c_str());
  std::exit(2);
}

std::vector<const Topic*> topics_named(std::string_view names) {
  std::vector<const Topic*> found;
  if (names == "all") {
    for (const Topic& topic : kTopics) found.push_back(&topic);
    return found;
  }
  while (!names.empty()) {
    const auto comma = names.find(',');
    found.push_back(&topic_named(names.substr(0, comma)));
    names = comma == std::string_view::npos ? "" : names.substr(comma + 1);
  }
  return found;
}

Wire::Wire(int domain, const std::string& machine, double lease_s) {
  configure(domain, lease_s);
  participant_ = must(dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr),
                      "participant");
  dds_qos_t* qos = dds_create_qos();
  const char* partition = machine.c_str();
  dds_qset_partition(qos, 1, &partition);
  publisher_ = must(dds_create_publisher(participant_, qos, nullptr), "publisher");
  subscriber_ = must(dds_create_subscriber(participant_, qos, nullptr), "subscriber");
  dds_delete_qos(qos);
  participants_ =
      must(dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
           "peers");
}

Wire::~Wire() { dds_delete(participant_); }

dds_entity_t Wire::reader(const Topic& topic, const Limits& limits) const {
  dds_qos_t* qos = make_qos(topic.quality, Side::kReader, limits);
  const dds_entity_t made = dds_create_reader(
      subscriber_, make_topic(participant_, topic, *topic.descriptor), qos, nullptr);
  dds_delete_qos(qos);
  return must(made, topic.name);
}

dds_entity_t Wire::writer(const Topic& topic) const {
  dds_qos_t* qos = make_qos(topic.quality, Side::kWriter, {});
  const dds_entity_t made = dds_create_writer(
      publisher_, make_topic(participant_, topic, *topic.descriptor), qos, nullptr);
  dds_delete_qos(qos);
  return must(made, topic.name);
}

dds_entity_t Wire::foreign_writer(const Topic& topic, const Topic& shape) const {
  // Without what says more of the type than its name: endpoints match by that alone then.
  const dds_topic_descriptor_t& content = *shape.descriptor;
  const std::uint32_t flags =
      content.m_flagset & ~static_cast<std::uint32_t>(DDS_TOPIC_XTYPES_METADATA);
  const dds_topic_descriptor_t descriptor{
      .m_size = content.m_size,
      .m_align = content.m_align,
      .m_flagset = flags,
      .m_nkeys = content.m_nkeys,
      .m_typename = topic.descriptor->m_typename,
      .m_keys = content.m_keys,
      .m_nops = content.m_nops,
      .m_ops = content.m_ops,
      .m_meta = content.m_meta,
      .type_information = {nullptr, 0},
      .type_mapping = {nullptr, 0},
      .restrict_data_representation = content.restrict_data_representation};
  dds_qos_t* qos = make_qos(topic.quality, Side::kWriter, {});
  const dds_entity_t made =
      dds_create_writer(publisher_, make_topic(participant_, topic, descriptor), qos, nullptr);
  dds_delete_qos(qos);
  return must(made, topic.name);
}

long Wire::process_of(dds_entity_t reader, dds_instance_handle_t writer) const {
  dds_builtintopic_endpoint_t* endpoint = dds_get_matched_publication_data(reader, writer);
  if (endpoint == nullptr) return 0;
  long process = 0;
  void* samples[1] = {nullptr};
  dds_sample_info_t info;
  if (dds_read_instance(participants_, samples, &info, 1, 1,
                        endpoint->participant_instance_handle) == 1) {
    const auto* peer = static_cast<const dds_builtintopic_participant_t*>(samples[0]);
    char* text = nullptr;
    if (info.valid_data && peer->qos != nullptr && dds_qget_prop(peer->qos, "__Pid", &text)) {
      process = std::strtol(text, nullptr, 10);
      dds_free(text);
    }
    (void)dds_return_loan(participants_, samples, 1);
  }
  dds_builtintopic_free_endpoint(endpoint);
  return process;
}

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void sleep_ns(std::int64_t duration_ns) noexcept {
  const timespec span{duration_ns / 1'000'000'000, duration_ns % 1'000'000'000};
  if (duration_ns > 0) ::nanosleep(&span, nullptr);
}

std::uint32_t crc32c(const void* data, std::size_t size, std::uint32_t seed) {
  std::uint32_t value = ~seed;
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) {
    value ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & 1U) != 0 ? (value >> 1U) ^ 0x82F63B78U : value >> 1U;
    }
  }
  return ~value;
}

std::uint32_t crc_of(const meridian_wire_ClBatch& batch) {
  unsigned char head[21];
  std::memcpy(head, &batch.session, 8);
  std::memcpy(head + 8, &batch.first_sequence, 8);
  std::memcpy(head + 16, &batch.count, 4);
  head[20] = batch.is_end;
  const std::size_t used = std::min<std::size_t>(batch.count, meridian_wire_kBatchBlocks);
  static_assert(sizeof batch.blocks[0] == 160, "as idl/README.md counts the bytes of a block");
  return crc32c(batch.blocks, 160 * used, crc32c(head, sizeof head));
}

std::uint32_t crc_of(const meridian_wire_Setpoint& setpoint, std::uint64_t service_id) {
  constexpr std::size_t kSummed = offsetof(meridian_wire_Setpoint, crc32c);
  static_assert(kSummed == 120, "as idl/README.md counts the bytes of a setpoint");
  return crc32c(&setpoint, kSummed, crc32c(&service_id, sizeof service_id));
}

}  // namespace attack
