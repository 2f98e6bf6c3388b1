// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/doctor/dds_network.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "service/host/process/programs.hpp"

namespace meridian::probe {
namespace {

/// A host with an interface eth1 in a network where all is well until a test says otherwise.
class DoctorOfDds : public testing::Test {
 protected:
  DoctorOfDds() {
    write("sys/class/net/lo/flags", "0x9\n");
    write("sys/class/net/eth1/flags", "0x1003\n");
    write("sys/class/net/eth1/operstate", "up\n");
    std::ifstream shipped(MERIDIAN_SOURCE_DIR "/deploy/cyclonedds-hosts.xml");
    write("etc/hosts.xml", {std::istreambuf_iterator<char>(shipped), {}});
  }
  void write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((root_.path() / path).parent_path());
    std::ofstream(root_.path() / path) << text;
  }
  [[nodiscard]] Findings examine(const std::string& uri) const {
    return examine_dds_network(
        HostFiles(root_.path()), uri,
        {[](const std::string& address) { return address == "10.0.0.1" ? "eth1" : ""; },
         [this](const std::string& interface) {
           return has_multicast_ && (interface == "eth1" || interface.empty());
         },
         [this](const std::string& peer) {
           const auto at = peers_.find(peer);
           return at == peers_.end() ? Reach::kAnswers : at->second;
         }});
  }
  /// One finding of `what`, of `health`, that says `found`; a remedy where one is due.
  void expect(const std::string& uri, const std::string& what, Health health,
              const std::string& found) const {
    int count = 0;
    for (const Finding& one : examine(uri)) {
      if (one.what != what) continue;
      ++count;
      EXPECT_EQ(one.health, health) << one.found;
      EXPECT_NE(one.found.find(found), std::string::npos) << one.found;
      EXPECT_EQ(one.remedy.empty(), health == Health::kFine) << one.found;
    }
    EXPECT_EQ(count, 1) << what;
  }
  [[nodiscard]] static std::string xml(const std::string& general, const std::string& peers = "") {
    return "<CycloneDDS><Domain><General>" + general + "</General><Discovery><Peers>" + peers +
           "</Peers></Discovery></Domain></CycloneDDS>";
  }

  static constexpr const char* kFile = "file:///etc/hosts.xml";
  const process::ScratchFolder root_;
  bool has_multicast_ = true;
  std::map<std::string, Reach> peers_;
};

TEST_F(DoctorOfDds, FindsTheShippedConfigurationOfSeveralHostsInOrder) {
  expect(kFile, "DDS interface", Health::kFine, "eth1");
  expect(kFile, "DDS multicast", Health::kFine, "not used: peers are named");
  EXPECT_EQ(examine(kFile).size(), 5U) << "three peers";
  EXPECT_TRUE(is_fit(examine(kFile)));
  EXPECT_EQ(examine("").size(), 2U);
  expect("", "DDS multicast", Health::kFine, "not used");
  expect("", "DDS interface", Health::kFine, "lo");
}

TEST_F(DoctorOfDds, FindsAnInterfaceThatIsNotThereOrDown) {
  write("sys/class/net/lo/flags", "0x8\n");
  expect("", "DDS interface", Health::kBad, "lo, which is down");
  write("sys/class/net/eth1/operstate", "down\n");
  expect(kFile, "DDS interface", Health::kBad, "eth1, which has no link");
  write("sys/class/net/eth1/flags", "0x1002\n");
  expect(kFile, "DDS interface", Health::kBad, "eth1, which is down");
  expect(xml(R"(<Interfaces><NetworkInterface name="eth7"/></Interfaces>)"), "DDS interface",
         Health::kBad, "eth7, which this host does not have");
  expect(xml(""), "DDS interface", Health::kNote, "none is named");
  expect("file:///etc/none.xml", "DDS interface", Health::kBad, "/etc/none.xml cannot be read");
}

TEST_F(DoctorOfDds, KnowsAnInterfaceByItsAddress) {
  expect(xml(R"(<NetworkInterface autodetermine="false" address="10.0.0.1"/>)"), "DDS interface",
         Health::kFine, "10.0.0.1 (eth1)");
  expect(xml("<NetworkInterfaceAddress>10.0.0.1</NetworkInterfaceAddress>"), "DDS interface",
         Health::kFine, "10.0.0.1 (eth1)");
  expect(xml(R"(<NetworkInterface address="10.9.9.9"/>)"), "DDS interface", Health::kBad,
         "10.9.9.9, which this host does not have");
}

TEST_F(DoctorOfDds, TriesMulticastWhereItIsUsed) {
  const std::string used = xml(R"(<NetworkInterface name="eth1"/>)");
  expect(used, "DDS multicast", Health::kFine, "works on eth1");
  has_multicast_ = false;
  expect(used, "DDS multicast", Health::kBad, "does not come back on eth1");
  write("sys/class/net/eth1/flags", "0x3\n");
  expect(used, "DDS multicast", Health::kBad, "eth1 carries none");
  const std::string off = R"(<NetworkInterface name="eth1"/><AllowMulticast>false</AllowMulticast>)"
                          "<!-- <AllowMulticast>true</AllowMulticast> -->";
  expect(xml(off), "DDS multicast", Health::kBad, "nobody is found");
  expect(xml(off, R"(<Peer address="a"/>)"), "DDS multicast", Health::kFine, "not used");
}

TEST_F(DoctorOfDds, TriesMulticastWhereTheHostSendsItIfNoInterfaceIsNamed) {
  expect(xml(""), "DDS multicast", Health::kFine, "by default");
  has_multicast_ = false;
  expect(xml(""), "DDS multicast", Health::kNote, "does not come back");
  expect(xml("<AllowMulticast>False</AllowMulticast>"), "DDS multicast", Health::kBad,
         "nobody is found");
}

TEST_F(DoctorOfDds, AsksEveryPeer) {
  peers_ = {{"192.168.10.1", Reach::kSilent},
            {"192.168.10.2", Reach::kNoRoute},
            {"192.168.10.3", Reach::kNoAddress}};
  expect(kFile, "DDS peer 192.168.10.1", Health::kNote, "silent");
  expect(kFile, "DDS peer 192.168.10.2", Health::kBad, "no way there");
  expect(kFile, "DDS peer 192.168.10.3", Health::kBad, "nobody knows");
  const std::string with_port =
      xml(R"(<NetworkInterface name="eth1"/>)", R"(<Peer Address="10.0.0.2:7410"/>)");
  expect(with_port, "DDS peer 10.0.0.2", Health::kFine, "answers");
}

TEST(RealNetwork, ReachesThisHostAndKnowsItsInterface) {
  const NetworkView network = real_network();
  EXPECT_EQ(network.reach("127.0.0.1"), Reach::kAnswers) << "it refuses, so it is there";
  EXPECT_EQ(network.reach("255.255.255.255"), Reach::kNoRoute);
  EXPECT_EQ(network.reach("no name at all"), Reach::kNoAddress);
  EXPECT_EQ(network.interface_of("127.0.0.1"), "lo");
  EXPECT_EQ(network.interface_of("no address"), "");
  EXPECT_FALSE(network.carries_multicast("none"));
}

}  // namespace
}  // namespace meridian::probe
