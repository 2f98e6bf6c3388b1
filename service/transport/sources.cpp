// SPDX-License-Identifier: Apache-2.0
#include "service/transport/sources.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>

#include "service/transport/entity.hpp"

namespace meridian::dds {
namespace {

struct EndpointDeleter {
  void operator()(dds_builtintopic_endpoint_t* endpoint) const noexcept {
    dds_builtintopic_free_endpoint(endpoint);
  }
};
using Endpoint = std::unique_ptr<dds_builtintopic_endpoint_t, EndpointDeleter>;

/// FNV-1a, never 0.
[[nodiscard]] std::uint64_t number_of(const dds_guid_t& guid) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const std::uint8_t byte : guid.v) hash = (hash ^ byte) * 0x100000001b3ULL;
  return hash != 0 ? hash : 1;
}

[[nodiscard]] std::string in_hex(const dds_guid_t& guid) {
  std::string text;
  for (const std::uint8_t byte : guid.v) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

[[nodiscard]] std::string property(const dds_qos_t* qos, const char* name) {
  char* value = nullptr;
  if (!dds_qget_prop(qos, name, &value) || value == nullptr) return "";
  std::string text = value;
  dds_free(value);
  return text;
}

/// Where the participant with that GUID says that it runs; empty where it does not.
[[nodiscard]] std::string origin_of(const Participant& participant, const dds_guid_t& guid) {
  const Entity reader(
      "participants",
      dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr));
  void* sample = nullptr;
  dds_sample_info_t info;
  std::string origin;
  while (origin.empty() && dds_take(reader.handle(), &sample, &info, 1, 1) == 1) {
    const auto* other = static_cast<const dds_builtintopic_participant_t*>(sample);
    if (info.valid_data && std::memcmp(other->key.v, guid.v, sizeof guid.v) == 0) {
      const std::string process = property(other->qos, "__Pid");
      const std::string host = property(other->qos, "__Hostname");
      if (!process.empty() && !host.empty()) origin = "process " + process + " on host " + host;
    }
    (void)dds_return_loan(reader.handle(), &sample, 1);
    sample = nullptr;
  }
  return origin;
}

}  // namespace

std::uint64_t participant_of(std::int32_t reader, std::uint64_t source) noexcept {
  const Endpoint writer(dds_get_matched_publication_data(reader, source));
  return writer ? number_of(writer->participant_key) : 0;
}

std::uint64_t number_of(const Participant& participant) noexcept {
  dds_guid_t guid{};
  return dds_get_guid(participant.handle(), &guid) == DDS_RETCODE_OK ? number_of(guid) : 0;
}

std::uint64_t Senders::participant_of(std::int32_t reader, std::uint64_t source) noexcept {
  const auto found = std::find_if(known_.begin(), known_.end(), [source](const Known& known) {
    return known.source == source && source != 0;
  });
  if (found != known_.end()) return found->participant;
  const std::uint64_t participant = dds::participant_of(reader, source);
  if (participant != 0) known_[at_++ % known_.size()] = {source, participant};
  return participant;
}

std::string describe_writers(const Participant& participant, const char* topic) {
  constexpr std::size_t kNamed = 5;
  const Entity reader(
      "writers",
      dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
  dds_guid_t own{};
  (void)dds_get_guid(participant.handle(), &own);
  std::string text;
  std::size_t count = 0;
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader.handle(), &sample, &info, 1, 1) == 1) {
    const auto* writer = static_cast<const dds_builtintopic_endpoint_t*>(sample);
    const bool is_other = info.valid_data && std::strcmp(writer->topic_name, topic) == 0 &&
                          std::memcmp(writer->participant_key.v, own.v, sizeof own.v) != 0;
    if (is_other && ++count <= kNamed) {
      const std::string origin = origin_of(participant, writer->participant_key);
      text += (text.empty() ? "" : ", ") +
              (!origin.empty() ? origin : "participant " + in_hex(writer->participant_key));
    }
    (void)dds_return_loan(reader.handle(), &sample, 1);
    sample = nullptr;
  }
  if (count > kNamed) text += " and " + std::to_string(count - kNamed) + " more";
  return count > 0 ? text : "nobody";
}

std::string describe_source(const Participant& participant, std::int32_t reader,
                            std::uint64_t source) {
  const Endpoint writer(dds_get_matched_publication_data(reader, source));
  if (!writer) return "a writer that is gone";
  return describe_participant(participant, writer->participant_key.v);
}

std::string describe_participant(const Participant& participant, const std::uint8_t* guid) {
  dds_guid_t key;
  std::memcpy(key.v, guid, sizeof key.v);
  const std::string origin = origin_of(participant, key);
  return !origin.empty() ? origin : "participant " + in_hex(key);
}

}  // namespace meridian::dds
