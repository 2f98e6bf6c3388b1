// SPDX-License-Identifier: Apache-2.0

/// The reference by itself: what this host can do without Meridian. Judged loosely, it only has to
/// be a measurement at all; its figures are the other half of every latency gate.

#include "latency/bare_reference.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "latency/figures.hpp"
#include "support/private_domain.hpp"

namespace meridian::latency {
namespace {

TEST(Figures, PercentilesAreByNearestRank) {
  std::vector<std::int64_t> samples;
  for (std::int64_t i = 1000; i >= 1; --i) {
    samples.push_back(i * 1000);
  }
  const Figures figures = figures_of(samples);
  EXPECT_EQ(figures.p50_us, 500);
  EXPECT_EQ(figures.p99_us, 990);
  EXPECT_EQ(figures.p999_us, 999);
  EXPECT_EQ(figures.max_us, 1000);
  EXPECT_EQ(figures.samples, 1000U);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(BareReference, MeasuresWakeAndPing) {
  const support::PrivateDomain domain;
  const int cpu = last_cpu();
  stay_off_cpu(cpu);
  BareReference bare(cpu, domain.id(), 1'000'000);
  Turns wake("bare thread, lateness");
  Turns ping("bare ping, one way");
  for (int turn = 0; turn < 3; ++turn) {
    wake.add(bare.wake_turn());
    ping.add(bare.ping_turn());
  }
  std::printf("%s\n%s\n%s\n", host_text().c_str(), wake.to_text().c_str(), ping.to_text().c_str());
  EXPECT_GT(wake.median_p50_us(), 0);
  EXPECT_GT(ping.median_p50_us(), 0);
  EXPECT_LT(ping.median_p50_us(), 5000) << "loopback takes longer than five periods";
}

}  // namespace
}  // namespace meridian::latency
