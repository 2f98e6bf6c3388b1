// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "attack/modes.hpp"

/// attacker MODE --domain N [--machine NAME] [--for S] ...: one attacker, on loopback alone, in
/// the domain of a test and for a bounded time. Run by tests/attack/campaign.py.
namespace attack {
namespace {

constexpr double kMaxDuration_s = 3600, kMaxRate_hz = 10'000;

struct Mode {
  std::string_view name;
  int (*run)(const Options&);
};

constexpr std::array<Mode, 9> kModes{{{"stick", stick},
                                      {"flood", flood},
                                      {"fake-service", fake_service},
                                      {"fake-drives", fake_drives},
                                      {"crowd", crowd},
                                      {"churn", churn},
                                      {"sessions", open_sessions},
                                      {"watch", watch},
                                      {"operate", operate}}};

bool read_option(Options& options, std::string_view name, const char* value) {
  const auto is = [name](std::string_view other) { return name == other; };
  if (is("--domain"))
    options.domain = std::atoi(value);
  else if (is("--machine"))
    options.machine = value;
  else if (is("--for"))
    options.duration_s = std::min(std::atof(value), kMaxDuration_s);
  else if (is("--rate"))
    options.rate_hz = std::clamp(std::atof(value), 0.01, kMaxRate_hz);
  else if (is("--count"))
    options.count = std::atoi(value);
  else if (is("--topics"))
    options.topics = value;
  else if (is("--shape"))
    options.shape = value;
  else if (is("--verb"))
    options.verb = std::atoi(value);
  else if (is("--max-samples"))
    options.max_samples = std::atoi(value);
  else if (is("--lease"))
    options.lease_s = std::atof(value);
  else if (is("--seed"))
    options.seed = std::strtoull(value, nullptr, 10);
  else if (is("--service-process"))
    options.service_process = std::atol(value);
  else if (is("--drives-process"))
    options.drives_process = std::atol(value);
  else if (is("--file"))
    options.file = value;
  else if (is("--operator-id"))
    options.operator_id = std::strtoull(value, nullptr, 10);
  else
    return false;
  return true;
}

int run(int argc, char** argv) {
  Options options;
  bool is_understood = argc >= 2 && argc % 2 == 0;
  for (int i = 2; is_understood && i + 1 < argc; i += 2) {
    is_understood = read_option(options, argv[i], argv[i + 1]);
  }
  const auto mode = std::find_if(kModes.begin(), kModes.end(),
                                 [&](const Mode& one) { return argc >= 2 && one.name == argv[1]; });
  if (!is_understood || mode == kModes.end() || options.domain < 0) {
    std::fprintf(stderr, "usage: attacker MODE --domain N [--for S] ...; modes:");
    for (const Mode& one : kModes) std::fprintf(stderr, " %s", one.name.data());
    std::fprintf(stderr, "\n");
    return 2;
  }
  options.mode = argv[1];
  return mode->run(options);
}

}  // namespace
}  // namespace attack

int main(int argc, char** argv) { return attack::run(argc, argv); }
