// SPDX-License-Identifier: Apache-2.0
#include "service/panel/doctor_text.hpp"

#include <cstdlib>

#include "service/host/probe/doctor.hpp"
#include "service/host/process/processors.hpp"

namespace meridian::panel {

std::string doctor_text() {
  const probe::HostFiles host;
  const char* const uri = std::getenv("CYCLONEDDS_URI");
  probe::Findings all = probe::examine_service_group(host);
  const auto add = [&all](const probe::Findings& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(probe::examine_isolation(host, process::last_cpu()));
  add(probe::examine_kernel(host));
  add(probe::examine_clocks(host, probe::read_time_of_day()));
  add(probe::examine_network(host, uri == nullptr ? "" : uri));
  return to_json(all);
}

}  // namespace meridian::panel
