// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "integration/process.hpp"

namespace meridian::test {

/// Four hosts on the network of deploy/cyclonedds-hosts.xml, as network namespaces: the service's,
/// the drives', the station's and a fourth that no configuration names. While it lives, programs
/// run on the host of their name (Process), each with a monotonic clock of its own where the kernel
/// gives programs such (it says where not), and the calling thread is on the fourth.
class Hosts {
 public:
  enum Name { kService, kDrives, kStation, kViewer };
  enum class Wire {
    kBridge,  ///< brings everything
    kSpoilt   ///< does what spoil() says
  };

  /// Why this machine has no hosts to give; empty: it has.
  [[nodiscard]] static std::string why_not();

  explicit Hosts(Wire wire = Wire::kBridge);
  ~Hosts();
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;

  /// Programs of that name, "meridiand" or a command of `meridian`, run on `host` from now
  /// on.
  void move(const std::string& program, Name host) { names_[program] = host; }

  /// Nothing comes through to or from that host any more, and it does not notice. On a bridge.
  void cut(Name host);
  void mend(Name host);

  /// From now on frames of the wire come so late and in shares of 100 not, twice, past others, or
  /// with a wrong bit.
  struct Spoilt {
    double delay_ms = 0, jitter_ms = 0;
    double lost = 0, twice = 0, past_others = 0, wrong = 0;
  };
  void spoil(const Spoilt& spoilt);
  /// Ends the wire: what it did.
  [[nodiscard]] std::string wire_said();

 private:
  [[nodiscard]] std::string space(const std::string& name) const;
  void connect(int host);
  void write_configuration();
  void set_port_state(Name host, const char* state) const;
  [[nodiscard]] const HostEnvironment* host_of(const std::vector<std::string>& arguments) const;

  std::string prefix_;
  std::filesystem::path folder_;
  int home_ = -1;  ///< network namespace of the test
  std::vector<HostEnvironment> environments_;
  std::map<std::string, Name> names_{
      {"meridiand", kService}, {"drives", kDrives}, {"stream", kStation}};
  HostEnvironment switch_;
  InputPipe wire_input_;
  std::unique_ptr<Process> wire_;
};

}  // namespace meridian::test
