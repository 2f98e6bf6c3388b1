// SPDX-License-Identifier: Apache-2.0
#include "service/transport/participant.hpp"

#include <dds/dds.h>
#include <dlfcn.h>

#include <cstdlib>
#include <map>
#include <mutex>

#include "dds_transport.hpp"
#include "service/transport/cyclone/loopback_sockets.hpp"
#include "service/transport/cyclone/network_config.hpp"

namespace meridian::dds {
namespace {

struct Domain {
  dds_entity_t handle = 0;
  int users = 0;
};

/// Domains that this process configured itself, by id; Cyclone deletes participants with them.
std::mutex domains_mutex;
std::map<std::uint32_t, Domain>& domains() {
  static std::map<std::uint32_t, Domain> all;
  return all;
}

[[noreturn]] void fail(const std::string& what, dds_return_t code, const char* remedy) {
  throw DdsError(what + ": " + dds_strretcode(-code) + "; " + remedy);
}

/// In front of whatever CYCLONEDDS_URI says, so that it may say otherwise: no writer waits for a
/// reader that does not acknowledge.
constexpr const char* kNeverWaits =
    "<CycloneDDS><Domain Id=\"any\"><Internal><Watermarks><WhcHigh>64 MB</WhcHigh>"
    "<WhcHighInit>64 MB</WhcHighInit><WhcAdaptive>false</WhcAdaptive></Watermarks></Internal>"
    "</Domain></CycloneDDS>,";

[[nodiscard]] std::string uri_of_environment() {
  const char* const uri = std::getenv("CYCLONEDDS_URI");
  return uri != nullptr ? uri : "";
}

[[nodiscard]] std::string configuration(const ParticipantOptions& options) {
  const std::string uri = uri_of_environment();
  if (!uri.empty()) return kNeverWaits + uri;
  return options.transport == Transport::kLoopbackRealtime ? kLoopbackRealtimeXml : kLoopbackXml;
}

void hold_domain(const ParticipantOptions& options) {
  const std::lock_guard lock(domains_mutex);
  Domain& domain = domains()[options.domain];
  if (domain.users == 0) {
    const bool stays = uri_of_environment().empty() || !leaves_host(uri_of_environment());
    const SocketsBefore before;
    domain.handle = dds_create_domain(options.domain, configuration(options).c_str());
    if (domain.handle < 0) {
      const dds_return_t code = domain.handle;
      domains().erase(options.domain);
      fail("DDS domain " + std::to_string(options.domain) + " cannot be set up", code,
           "choose a --domain from 0 to 230; is the loopback interface up, is what CYCLONEDDS_URI "
           "names a file of Cyclone DDS, and are real-time rights there if it asks for real-time "
           "threads, and its certificates and permissions if it asks for security?");
    }
    if (stays) before.confine_newer_to_loopback();
  }
  ++domain.users;
}

void release_domain(std::uint32_t id) {
  const std::lock_guard lock(domains_mutex);
  const auto found = domains().find(id);
  if (found == domains().end() || --found->second.users > 0) return;
  dds_delete(found->second.handle);
  domains().erase(found);
}

/// Cyclone loads its plugins with the first participant that its configuration gives an identity,
/// and creates none where that fails.
bool has_security_plugins() noexcept {
  void* const plugin = ::dlopen("libdds_security_auth.so", RTLD_LAZY | RTLD_NOLOAD);
  if (plugin == nullptr) return false;
  ::dlclose(plugin);
  return true;
}

}  // namespace

Participant::Participant(const ParticipantOptions& options)
    : domain_(static_cast<std::int32_t>(options.domain)) {
  hold_domain(options);
  participant_ = dds_create_participant(options.domain, nullptr, nullptr);
  if (participant_ < 0) {
    release_domain(options.domain);
    fail("no place in DDS domain " + std::to_string(options.domain), participant_,
         "is the loopback interface up, and are real-time rights there if CYCLONEDDS_URI asks for "
         "real-time threads, and its certificates and permissions if it asks for security?");
  }
  is_secured_ = has_security_plugins();
  leaves_host_ = !uri_of_environment().empty() && dds::leaves_host(uri_of_environment());
  if (is_open_network() && options.open_network == OpenNetwork::kRefused) {
    dds_delete(participant_);
    release_domain(options.domain);
    throw DdsError(
        "CYCLONEDDS_URI leads DDS off this host and names no identity: whoever reaches that "
        "network "
        "could move the machine; make identities (docs/security.md), or allow it with "
        "open_network = true in the service file, --open-network for drives and panel");
  }
  dds_qos_t* qos = dds_create_qos();
  const char* partition = options.machine.c_str();
  dds_qset_partition(qos, 1, &partition);
  publisher_ = dds_create_publisher(participant_, qos, nullptr);
  subscriber_ = dds_create_subscriber(participant_, qos, nullptr);
  dds_delete_qos(qos);
  if (publisher_ < 0 || subscriber_ < 0) {
    dds_delete(participant_);
    release_domain(options.domain);
    fail("DDS partition '" + options.machine + "' cannot be joined",
         publisher_ < 0 ? publisher_ : subscriber_, "give the machine a plain name");
  }
}

Participant::~Participant() {
  dds_delete(participant_);
  release_domain(static_cast<std::uint32_t>(domain_));
}

}  // namespace meridian::dds
