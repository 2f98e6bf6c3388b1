// SPDX-License-Identifier: Apache-2.0
#include "service/cli/host_findings.hpp"

#include <cstdlib>

namespace meridian::cli {

probe::Findings examine_host(int cpu, const std::string& cyclone_uri,
                             const probe::Rights* rights) {
  const probe::HostFiles host;
  probe::Findings all;
  const auto add = [&all](const probe::Findings& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (rights != nullptr) add(probe::examine_rights(host, *rights));
  add(probe::examine_service_group(host));
  add(probe::examine_isolation(host, cpu));
  if (rights != nullptr) add(probe::examine_processors(host, *rights));
  add(probe::examine_kernel(host));
  add(probe::examine_clocks(host, probe::read_time_of_day()));
  add(probe::examine_network(host, cyclone_uri));
  return all;
}

std::string cyclone_uri() {
  const char* const uri = std::getenv("CYCLONEDDS_URI");
  return uri == nullptr ? "" : uri;
}

}  // namespace meridian::cli
