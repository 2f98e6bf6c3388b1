// SPDX-License-Identifier: Apache-2.0
#include "latency/bare_reference.hpp"

#include <chrono>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace meridian::latency {
namespace {

constexpr char kPartition[] = "bare_ping";
constexpr std::chrono::seconds kWithin{30};

}  // namespace

BareReference::BareReference(int cpu, std::uint32_t domain, std::int64_t period_ns)
    : drive_side_(domain, kPartition),
      process_({MERIDIAN_BARE_PEER, std::to_string(cpu), std::to_string(domain),
                std::to_string(period_ns), kPartition}) {
  if (process_.read_line(kWithin) != "ready") {
    throw std::runtime_error("the bare reference does not start");
  }
  const auto give_up = std::chrono::steady_clock::now() + kWithin;
  while (!drive_side_.is_connected()) {
    if (std::chrono::steady_clock::now() > give_up) {
      throw std::runtime_error("the bare ping is not seen");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

std::string BareReference::ask(const std::string& verb) {
  process_.write_line(verb + " " + std::to_string(kWarmUpPeriods + kTurnPeriods));
  const auto answer = process_.read_line(kWithin);
  if (!answer) {
    throw std::runtime_error("the bare reference does not answer");
  }
  return *answer;
}

std::vector<std::int64_t> BareReference::wake_turn() {
  std::istringstream numbers(ask("wake"));
  std::vector<std::int64_t> late_ns;
  std::size_t i = 0;
  for (std::int64_t late = 0; numbers >> late; ++i) {
    if (i >= kWarmUpPeriods) {
      late_ns.push_back(late);
    }
  }
  return late_ns;
}

std::vector<std::int64_t> BareReference::ping_turn() {
  drive_side_.forget();
  std::istringstream numbers(ask("ping"));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the last one is on its way
  std::map<std::uint64_t, std::int64_t> written_ns;
  std::uint64_t cycle = 0;
  char colon = 0;
  for (std::int64_t at = 0; numbers >> cycle >> colon >> at;) {
    written_ns[cycle] = at;
  }
  std::vector<std::int64_t> one_way_ns;
  for (const DriveSide::Arrival& arrival : drive_side_.arrivals()) {
    if (arrival.cycle >= kWarmUpPeriods) {
      one_way_ns.push_back(arrival.seen_ns - written_ns.at(arrival.cycle));
    }
  }
  return one_way_ns;
}

}  // namespace meridian::latency
