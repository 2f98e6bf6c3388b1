// SPDX-License-Identifier: Apache-2.0
#include "integration/hosts.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <regex>
#include <sstream>
#include <system_error>

namespace meridian::test {
namespace {

constexpr std::array<const char*, 4> kNames{"service", "drives", "station", "viewer"};
constexpr const char* kInterface = "eth1";  // as the shipped configuration calls it

/// Runs a tool of iproute2; false where it fails.
bool run_tool(const std::string& line) {
  return std::system(("PATH=$PATH:/usr/sbin:/sbin " + line + " 2>/dev/null").c_str()) == 0;
}
bool ip(const std::string& words) { return run_tool("ip " + words); }

void must(const std::string& words) { EXPECT_TRUE(ip(words)) << "ip " << words; }

void enter_network(const std::string& file) {
  const int space = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(::setns(space, CLONE_NEWNET), 0) << file;
  ::close(space);
}

/// Checksums are made before a frame is on the wire, as without an interface that makes them.
void make_checksums() {
  ethtool_value off{ETHTOOL_STXCSUM, 0};
  ifreq request{};
  std::strncpy(request.ifr_name, kInterface, IFNAMSIZ - 1);
  request.ifr_data = reinterpret_cast<char*>(&off);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(::ioctl(socket, SIOCETHTOOL, &request), 0) << std::strerror(errno);
  ::close(socket);
}

/// Whether programs get monotonic clocks of their own: older kernels give them to what these start.
[[nodiscard]] bool has_clocks() {
  const std::string is_elsewhere =
      "[ ! /proc/self/ns/time -ef /proc/" + std::to_string(::getpid()) + "/ns/time ]";
  const pid_t child = ::fork();
  if (child == 0) {
    if (set_uptime_ahead(1)) ::execl("/bin/sh", "sh", "-c", is_elsewhere.c_str(), nullptr);
    ::_exit(1);
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && status == 0;
}

/// Network namespaces outlive a test that was killed, whose process is in their name.
void remove_left_behind() {
  std::error_code none;
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("/run/netns", none)) {
    names.push_back(entry.path().filename());
  }
  for (const std::string& name : names) {
    int pid = 0;
    const bool is_ours = std::sscanf(name.c_str(), "meridian-%d-", &pid) == 1 && pid > 0;
    if (is_ours && ::kill(pid, 0) != 0 && errno == ESRCH) (void)ip("netns del " + name);
  }
}

[[nodiscard]] std::string port(int host) { return "port" + std::to_string(host); }

}  // namespace

std::string Hosts::why_not() {
  const std::string probe = "meridian-probe-" + std::to_string(::getpid());
  if (::geteuid() != 0) return "network namespaces need root";
  if (!ip("-V >/dev/null")) return "there is no ip (Debian package iproute2)";
  const bool has_spaces = ip("netns add " + probe) &&
                          ip("-n " + probe + " link add name br0 type bridge") &&
                          ip("-n " + probe + " link add name port0 type veth");
  (void)ip("netns del " + probe);
  return has_spaces ? "" : "this kernel makes no network namespaces with a bridge";
}

std::string Hosts::space(const std::string& name) const { return prefix_ + name; }

Hosts::Hosts(Wire wire)
    : prefix_("meridian-" + std::to_string(::getpid()) + "-"),
      folder_(std::filesystem::temp_directory_path() / (prefix_ + "hosts")),
      home_(::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC)) {
  remove_left_behind();
  std::filesystem::create_directories(folder_);
  write_configuration();
  switch_.network = "/run/netns/" + space("switch");
  must("netns add " + space("switch"));
  if (wire == Wire::kBridge) must("-n " + space("switch") + " link add name br0 up type bridge");
  for (int host = 0; host < static_cast<int>(kNames.size()); ++host) {
    connect(host);
    if (wire == Wire::kBridge) {
      must("-n " + space("switch") + " link set " + port(host) + " master br0");
    }
  }
  Process::host_of = [this](const auto& arguments) { return host_of(arguments); };
  if (wire == Wire::kSpoilt) {
    wire_ = std::make_unique<Process>(
        std::vector<std::string>{"spoilt_wire", port(0), port(1), port(2), port(3)},
        folder_ / "wire.log", &wire_input_);
  }
  const HostEnvironment& viewer = environments_[kViewer];
  enter_network(viewer.network);
  ::setenv("CYCLONEDDS_URI", viewer.dds.c_str(), 1);
}

Hosts::~Hosts() {
  Process::host_of = nullptr;
  wire_.reset();
  ::unsetenv("CYCLONEDDS_URI");
  (void)::setns(home_, CLONE_NEWNET);
  ::close(home_);
  for (const char* name : kNames) (void)ip("netns del " + space(name));
  (void)ip("netns del " + space("switch"));
  std::filesystem::remove_all(folder_);
}

/// As it ships where the host is named in it; stations and viewers have no real-time threads.
void Hosts::write_configuration() {
  const std::string shipped = std::string(MERIDIAN_SOURCE_DIR) + "/deploy/cyclonedds-hosts.xml";
  std::ostringstream text;
  text << std::ifstream(shipped).rdbuf();
  const std::string plain = folder_ / "plain.xml";
  std::ofstream(plain) << std::regex_replace(text.str(), std::regex("<Scheduling>.*?</Scheduling>"),
                                             "");
  const long apart_s = has_clocks() ? 100'000 : 0;
  if (apart_s == 0) {
    std::printf("all hosts share one monotonic clock here: that theirs differ is not covered\n");
  }
  for (int host = 0; host < static_cast<int>(kNames.size()); ++host) {
    const bool has_realtime = host == kService || host == kDrives;
    environments_.push_back(
        {.network = "/run/netns/" + space(kNames[static_cast<std::size_t>(host)]),
         .dds = "file://" + (has_realtime ? shipped : plain),
         .uptime_ahead_s = apart_s * host});
  }
}

void Hosts::connect(int host) {
  const std::string name = space(kNames[static_cast<std::size_t>(host)]);
  const std::string into = "-n " + name + " ";
  must("netns add " + name);
  must(into + "link add " + kInterface + " type veth peer name " + port(host) + " netns " +
       space("switch"));
  must(into + "addr add 192.168.10." + std::to_string(host + 1) + "/24 dev " + kInterface);
  must(into + "link set lo up");
  must(into + "link set " + kInterface + " up");
  must("-n " + space("switch") + " link set " + port(host) + " up");
  enter_network("/run/netns/" + name);
  make_checksums();
  EXPECT_EQ(::setns(home_, CLONE_NEWNET), 0);
}

const HostEnvironment* Hosts::host_of(const std::vector<std::string>& arguments) const {
  if (arguments[0] == "spoilt_wire") return &switch_;
  const auto found = names_.find(arguments[arguments[0] == "meridian" ? 1 : 0]);
  return &environments_[found == names_.end() ? kViewer : found->second];
}

void Hosts::cut(Name host) { set_port_state(host, "0"); }

void Hosts::mend(Name host) { set_port_state(host, "3"); }

void Hosts::set_port_state(Name host, const char* state) const {
  EXPECT_TRUE(
      run_tool("bridge -n " + space("switch") + " link set dev " + port(host) + " state " + state));
}

void Hosts::spoil(const Spoilt& spoilt) {
  std::ostringstream line;
  line << spoilt.delay_ms << ' ' << spoilt.jitter_ms << ' ' << spoilt.lost << ' ' << spoilt.twice
       << ' ' << spoilt.past_others << ' ' << spoilt.wrong << '\n';
  wire_input_.write(line.str());
}

std::string Hosts::wire_said() {
  wire_input_.close();
  EXPECT_EQ(wire_->wait(milliseconds(2000)), 0);
  return wire_->said();
}

}  // namespace meridian::test
