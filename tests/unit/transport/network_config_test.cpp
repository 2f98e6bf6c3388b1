// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/network_config.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "service/transport/participant.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

TEST(NetworkConfig, ReadsCommentsAndTagsOfAnyLengthInEitherQuotes) {
  const std::string comment = "<!-- <Peer address='x'/> " + std::string(500'000, '-') + " -->";
  const std::string spaces(500'000, ' ');
  const NetworkConfig read = read_network_config(
      comment + "<NetworkInterface " + spaces + "priority='1' name = 'eth1' />" + comment +
      "<Peer Address='10.0.0.2'/><Peer\naddress=\"it's\"/><!-- not closed <Peer address='y'/>");
  EXPECT_EQ(read.interfaces, std::vector<std::string>{"eth1"});
  EXPECT_EQ(read.peers, (std::vector<std::string>{"10.0.0.2", "it's"}));
  for (const char* broken : {"<", "<Peer", "<Peer address", "<Peer address=", "<Peer address='x",
                             "<Peer address=x/>", "<Peer/>", "<!--"}) {
    EXPECT_TRUE(read_network_config(broken).peers.empty()) << broken;
  }
}

TEST(NetworkConfig, StaysOnTheHostOnlyWhereEveryInterfaceIsLoopback) {
  const auto leaves = [](const std::string& xml) { return leaves_host("<x>" + xml); };
  EXPECT_FALSE(leaves("<NetworkInterface name=\"lo\"/>"));
  EXPECT_FALSE(leaves("<NetworkInterface address=\"127.0.0.1\"/>"));
  EXPECT_FALSE(leaves("<NetworkInterfaceAddress>127.0.0.1</NetworkInterfaceAddress>"));
  EXPECT_TRUE(leaves("<NetworkInterface name=\"eth1\"/>"));
  EXPECT_TRUE(leaves("<NetworkInterface name=\"lo\"/><NetworkInterface name=\"eth1\"/>"));
  EXPECT_TRUE(leaves("<NetworkInterface name=\"lo\"/><NetworkInterface autodetermine=\"true\"/>"));
  EXPECT_TRUE(leaves("")) << "Cyclone chooses";
  EXPECT_TRUE(leaves_host(std::string("file:///none/of/this/name.xml")));
}

TEST(NetworkConfig, OfTheShippedFilesIsLoopbackButForTheOneOfSeveralHosts) {
  const std::string deploy = std::string("file://") + MERIDIAN_SOURCE_DIR + "/deploy/";
  EXPECT_FALSE(leaves_host(deploy + "cyclonedds-loopback.xml"));
  EXPECT_FALSE(leaves_host(deploy + "cyclonedds-loopback-rt.xml"));
  EXPECT_TRUE(leaves_host(deploy + "cyclonedds-hosts.xml"));
}

/// CYCLONEDDS_URI for as long as it lives.
class Environment {
 public:
  explicit Environment(const char* uri) { ::setenv("CYCLONEDDS_URI", uri, 1); }
  ~Environment() { ::unsetenv("CYCLONEDDS_URI"); }
};

constexpr const char* kAllInterfaces =
    "<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex></Discovery></Domain></CycloneDDS>";

TEST(OpenNetwork, IsRefusedWithoutAnIdentityAndSaysHowToAllowIt) {
  const support::PrivateDomain domain;
  const Environment environment(kAllInterfaces);
  const ParticipantOptions options{
      .domain = domain.id(), .machine = "mill", .open_network = OpenNetwork::kRefused};
  try {
    const Participant participant(options);
    FAIL() << "it started";
  } catch (const DdsError& error) {
    EXPECT_NE(std::string(error.what()).find("open_network = true"), std::string::npos);
  }
}

TEST(OpenNetwork, IsSaidWhereItIsAllowed) {
  const support::PrivateDomain domain;
  const Environment environment(kAllInterfaces);
  const Participant participant({.domain = domain.id(), .machine = "mill"});
  EXPECT_TRUE(participant.is_open_network());
}

TEST(OpenNetwork, IsNoneOnLoopback) {
  const support::PrivateDomain domain;
  const Participant participant(
      {.domain = domain.id(), .machine = "mill", .open_network = OpenNetwork::kRefused});
  EXPECT_FALSE(participant.leaves_host());
  EXPECT_FALSE(participant.is_open_network());
}

}  // namespace
}  // namespace meridian::dds
