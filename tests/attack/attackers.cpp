// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "attack/modes.hpp"
#include "attack/samples.hpp"
#include "attack/wire.hpp"

namespace attack {
namespace {

[[nodiscard]] std::int64_t ns_of(double seconds) {
  return static_cast<std::int64_t>(1e9 * seconds);
}

void report_begin(const Options& options) {
  std::printf("attacking: %s %s\n", options.mode.c_str(), options.topics.c_str());
  std::fflush(stdout);
}

/// Calls `act` at the rate until time is over, all that are due at once where it is late.
template <class Act>
std::uint64_t pace(const Options& options, const Act& act) {
  const std::int64_t begin_ns = monotonic_ns(), end_ns = begin_ns + ns_of(options.duration_s);
  std::uint64_t done = 0;
  for (std::int64_t now_ns = begin_ns; now_ns < end_ns; now_ns = monotonic_ns()) {
    const auto due =
        static_cast<std::uint64_t>(1e-9 * static_cast<double>(now_ns - begin_ns) * options.rate_hz);
    for (; done < due && monotonic_ns() < end_ns; ++done) act();
    sleep_ns(std::min<std::int64_t>(1'000'000, ns_of(1 / options.rate_hz)));
  }
  return done;
}

/// One topic that is flooded.
struct Stream {
  const Topic* topic;
  dds_entity_t writer;
  Maker maker;
};

[[nodiscard]] std::vector<Stream> open_streams(const Wire& wire, const Options& options) {
  const Shape shape = shape_named(options.shape);
  std::vector<Stream> streams;
  for (const Topic* topic : topics_named(options.topics)) {
    // ActionDone has no key, as a drive's command has one: endpoints match by that too.
    const bool is_keyed = topic->descriptor->m_nkeys > 0;
    const char* other = is_keyed ? "drive_command" : "action_done";
    if (topic_named(other).descriptor == topic->descriptor) other = is_keyed ? "status" : "action";
    const bool is_foreign = shape == Shape::kForeign;
    const Topic& content = is_foreign ? topic_named(other) : *topic;
    streams.push_back({topic,
                       is_foreign ? wire.foreign_writer(*topic, content) : wire.writer(*topic),
                       Maker(content, shape, options.seed + streams.size(), options.verb)});
  }
  return streams;
}

}  // namespace

int stick(const Options& options) {
  const Wire wire(options.domain, options.machine, options.lease_s);
  for (const Topic* topic : topics_named(options.topics)) {
    (void)wire.reader(*topic, {.max_samples = options.max_samples});
  }
  report_begin(options);
  sleep_ns(ns_of(options.duration_s));
  return 0;
}

int flood(const Options& options) {
  const Wire wire(options.domain, options.machine, options.lease_s);
  Ears ears(wire);
  std::vector<Stream> streams = open_streams(wire, options);
  (void)ears.waits_for_status(3'000'000'000);
  report_begin(options);
  std::uint64_t refused = 0, n = 0;
  const std::uint64_t sent = pace(options, [&] {
    if (n % 8 == 0 || options.rate_hz < 500) ears.listen();
    Stream& stream = streams[n++ % streams.size()];
    if (dds_write(stream.writer, stream.maker.next(ears.heard())) != DDS_RETCODE_OK) ++refused;
  });
  std::printf("sent %llu, not taken %llu\n", static_cast<unsigned long long>(sent),
              static_cast<unsigned long long>(refused));
  return 0;
}

int fake_service(const Options& options) {
  const Wire wire(options.domain, options.machine, options.lease_s);
  Ears ears(wire);
  Options words = options;
  words.topics = "machine,status,drive_command,setpoint,reply,cl_credit,action";
  std::vector<Stream> streams = open_streams(wire, words);
  report_begin(options);
  std::uint64_t tick = 0;
  words.rate_hz = 1000;
  (void)pace(words, [&] {
    ears.listen();
    constexpr std::uint64_t kPeriods_ms[] = {500, 50, 10, 1, 5, 100, 1000};
    for (std::size_t i = 0; i < streams.size(); ++i) {
      if (tick % kPeriods_ms[i] == 0) {
        (void)dds_write(streams[i].writer, streams[i].maker.next(ears.heard()));
      }
    }
    ++tick;
  });
  return 0;
}

int fake_drives(const Options& options) {
  const Wire wire(options.domain, options.machine, options.lease_s);
  Ears ears(wire);
  Options words = options;
  words.topics = "feedback,action_done";
  std::vector<Stream> streams = open_streams(wire, words);
  report_begin(options);
  words.rate_hz = 1000;
  std::uint64_t tick = 0;
  (void)pace(words, [&] {
    ears.listen();
    (void)dds_write(streams[0].writer, streams[0].maker.next(ears.heard()));
    if (tick++ % 100 == 0) {
      (void)dds_write(streams[1].writer, streams[1].maker.next(ears.heard()));
    }
  });
  return 0;
}

int crowd(const Options& options) {
  std::vector<std::unique_ptr<Wire>> all;
  for (int n = 0; n < options.count; ++n) {
    all.push_back(std::make_unique<Wire>(options.domain, options.machine, options.lease_s));
    for (const char* name : {"status", "reply", "setpoint"}) {
      (void)all.back()->reader(topic_named(name));
    }
    for (const char* name : {"command", "cl_session"}) {
      (void)all.back()->writer(topic_named(name));
    }
  }
  std::printf("participants: %zu\n", all.size());
  report_begin(options);
  sleep_ns(ns_of(options.duration_s));
  return 0;
}

int churn(const Options& options) {
  const Wire stays(options.domain, options.machine, options.lease_s);  // keeps the domain
  report_begin(options);
  std::vector<std::unique_ptr<Wire>> all(static_cast<std::size_t>(std::max(1, options.count)));
  std::size_t n = 0;
  const std::uint64_t come = pace(options, [&] {
    auto& one = all[n++ % all.size()];
    one.reset();
    one = std::make_unique<Wire>(options.domain, options.machine, options.lease_s);
    for (const char* name : {"status", "reply", "cl_credit"}) (void)one->reader(topic_named(name));
    for (const char* name : {"command", "cl_session", "jog"}) (void)one->writer(topic_named(name));
  });
  std::printf("came %llu\n", static_cast<unsigned long long>(come));
  return 0;
}

int open_sessions(const Options& options) {
  const Wire wire(options.domain, options.machine, options.lease_s);
  const dds_entity_t writer = wire.writer(topic_named("cl_session"));
  Maker maker(topic_named("cl_session"), Shape::kWell, options.seed);
  const Heard nobody{};
  report_begin(options);
  const std::uint64_t sent = pace(options, [&] { (void)dds_write(writer, maker.next(nobody)); });
  std::printf("opened and closed %llu\n", static_cast<unsigned long long>(sent / 2));
  return 0;
}

}  // namespace attack
