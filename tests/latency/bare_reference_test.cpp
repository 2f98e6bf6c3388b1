// SPDX-License-Identifier: Apache-2.0

/// The reference by itself: what this host can do without Meridian. Checked loosely, it only has to
/// be a measurement at all; its figures are the other half of every latency gate.

#include "service/host/probe/run/bare_reference.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "service/host/probe/figures.hpp"
#include "service/host/process/processors.hpp"
#include "support/private_domain.hpp"

namespace meridian::probe {
namespace {

TEST(BareReference, MeasuresWakeAndPing) {
  const support::PrivateDomain domain;
  const int cpu = process::last_cpu();
  process::stay_off_cpu(cpu);
  BareReference bare(cpu, domain.id(), 1'000'000);
  Turns wake("bare thread, lateness");
  Turns ping("bare ping, one way");
  Turns round_trip("bare ping, round trip");
  for (int turn = 0; turn < 3; ++turn) {
    wake.add(bare.wake_turn());
    const BareReference::Pings pings = bare.ping_turn();
    ping.add(pings.one_way_ns);
    round_trip.add(pings.round_trip_ns);
  }
  std::printf("%s\n%s\n%s\n%s\n", host_text().c_str(), wake.to_text().c_str(),
              ping.to_text().c_str(), round_trip.to_text().c_str());
  EXPECT_GT(wake.median_p50_us(), 0);
  EXPECT_GT(ping.median_p50_us(), 0);
  EXPECT_GT(round_trip.median_p50_us(), ping.median_p50_us());
  EXPECT_LT(ping.median_p50_us(), 5000) << "loopback takes longer than five periods";
}

}  // namespace
}  // namespace meridian::probe
