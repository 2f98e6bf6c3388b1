// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <map>

#include "attack/modes.hpp"
#include "attack/wire.hpp"

namespace attack {
namespace {

volatile std::sig_atomic_t is_over = 0;

/// Setpoints as they are on the wire, whoever sends them: services are numbered as they come.
class Watch {
 public:
  Watch(const Wire& wire, std::FILE* file)
      : reader_(wire.reader(topic_named("setpoint"), {.depth = 8192})), file_(file) {
    std::fputs("service,cycle,due_ns,line,flags,p0,p1,p2,p3,p4,p5\n", file_);
  }

  void poll() {
    meridian_wire_Setpoint sample;
    void* samples[1] = {&sample};
    dds_sample_info_t info;
    while (dds_take(reader_, samples, &info, 1, 1) == 1) {
      if (!info.valid_data || (sample.flags & 1U) == 0) continue;
      const auto [at, is_new] = services_.try_emplace(info.publication_handle, services_.size());
      std::fprintf(file_, "%zu,%llu,%lld,%u,%u", at->second,
                   static_cast<unsigned long long>(sample.cycle),
                   static_cast<long long>(sample.due_ns), sample.line, sample.flags);
      for (const double position : sample.position) std::fprintf(file_, ",%.9g", position);
      std::fputc('\n', file_);
    }
    std::fflush(file_);
  }

 private:
  dds_entity_t reader_;
  std::FILE* file_;
  std::map<dds_instance_handle_t, std::size_t> services_;
};

}  // namespace

int watch(const Options& options) {
  std::FILE* const file = std::fopen(options.file.c_str(), "w");
  if (file == nullptr) return 1;
  std::signal(SIGTERM, [](int) { is_over = 1; });
  const Wire wire(options.domain, options.machine, options.lease_s);
  Watch one(wire, file);
  std::printf("watching\n");
  std::fflush(stdout);
  const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(1e9 * options.duration_s);
  while (is_over == 0 && monotonic_ns() < end_ns) {
    one.poll();
    sleep_ns(2'000'000);
  }
  one.poll();
  return std::fclose(file) == 0 ? 0 : 1;
}

}  // namespace attack
