// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/bare_reference.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "service/host/process/programs.hpp"

namespace meridian::probe {
namespace {

constexpr char kPartition[] = "bare_ping";
constexpr std::chrono::seconds kWithin{30};

}  // namespace

BareReference::BareReference(int cpu, std::uint32_t domain, std::int64_t period_ns, int priority)
    : cpu_(cpu),
      warm_up_(static_cast<std::size_t>(kWarmUp_ns / period_ns)),
      periods_(static_cast<std::size_t>(kTurn_ns / period_ns)),
      drive_side_(domain, kPartition),
      process_({process::program_beside("meridian").string(), "probe", "--bare-peer",
                std::to_string(cpu), std::to_string(domain), std::to_string(period_ns), kPartition,
                std::to_string(priority)},
               {.has_own_group = true}) {
  drive_side_.answer(true);
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
  process_.write_line(verb + " " + std::to_string(warm_up_ + periods_));
  const auto answer = process_.read_line(kWithin);
  if (!answer) {
    throw std::runtime_error("the bare reference does not answer");
  }
  std::istringstream words(*answer);
  std::size_t elsewhere = 0;
  std::string samples;
  words >> elsewhere;
  if (elsewhere > 0) {
    throw std::runtime_error("the bare reference was not on processor " + std::to_string(cpu_) +
                             " in " + std::to_string(elsewhere) + " of its wakes");
  }
  std::getline(words, samples);
  return samples;
}

std::vector<std::int64_t> BareReference::wake_turn() {
  std::istringstream numbers(ask("wake"));
  std::vector<std::int64_t> late_ns;
  std::size_t i = 0;
  for (std::int64_t late = 0; numbers >> late; ++i) {
    if (i >= warm_up_) {
      late_ns.push_back(late);
    }
  }
  return late_ns;
}

BareReference::Pings BareReference::ping_turn() {
  drive_side_.forget();
  std::istringstream numbers(ask("ping"));
  std::map<std::uint64_t, std::int64_t> written_ns;
  Pings pings;
  std::uint64_t cycle = 0;
  char colon = 0;
  std::int64_t round_trip_ns = 0;
  for (std::int64_t at = 0; numbers >> cycle >> colon >> at >> colon >> round_trip_ns;) {
    written_ns[cycle] = at;
    if (cycle < warm_up_) continue;
    ++pings.unseen.of;
    if (round_trip_ns > 0) pings.round_trip_ns.push_back(round_trip_ns);
  }
  for (const DriveSide::Arrival& arrival : drive_side_.arrivals()) {
    if (arrival.cycle >= warm_up_) {
      pings.one_way_ns.push_back(arrival.seen_ns - written_ns.at(arrival.cycle));
    }
  }
  pings.unseen.missing =
      pings.unseen.of - std::min<std::uint64_t>(pings.unseen.of, pings.one_way_ns.size());
  return pings;
}

}  // namespace meridian::probe
