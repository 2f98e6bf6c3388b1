// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/account.hpp"

#include <sched.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace meridian::process {
namespace {

namespace fs = std::filesystem;

/// What stands behind `key` in a file of lines "key: text"; empty where there is none.
[[nodiscard]] std::string text_in(const fs::path& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    const auto begin = line.find_first_not_of(" \t", key.size());
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return {};
}

/// The same as a number; 0 where there is none.
[[nodiscard]] std::uint64_t number_in(const fs::path& path, const std::string& key) {
  return std::strtoull(text_in(path, key).c_str(), nullptr, 10);
}

struct Stat {
  std::uint64_t minor_faults = 0, major_faults = 0;
  int policy = 0, priority = 0;
};

/// Fields 10, 12, 40 and 41 of a stat file, counted after the name in brackets.
[[nodiscard]] Stat read_stat(const fs::path& path) {
  Stat stat;
  std::ifstream file(path);
  std::string text;
  std::getline(file, text);
  const auto bracket = text.rfind(')');
  if (bracket == std::string::npos) return stat;
  std::istringstream words(text.substr(bracket + 1));
  std::string word;
  for (int field = 3; words >> word; ++field) {
    const std::uint64_t number = std::strtoull(word.c_str(), nullptr, 10);
    if (field == 10) stat.minor_faults = number;
    if (field == 12) stat.major_faults = number;
    if (field == 40) stat.priority = static_cast<int>(number);
    if (field == 41) stat.policy = static_cast<int>(number);
  }
  return stat;
}

[[nodiscard]] int count_in(const fs::path& folder) {
  std::error_code gone;
  const auto entries = fs::directory_iterator(folder, gone);
  return gone ? 0 : static_cast<int>(std::distance(begin(entries), end(entries)));
}

}  // namespace

std::optional<Account> account_of(pid_t process) {
  const fs::path folder = fs::path("/proc") / std::to_string(process);
  const auto resident_kib = number_in(folder / "status", "VmRSS:");
  if (resident_kib == 0) return std::nullopt;
  Account account;
  account.resident_mib = static_cast<double>(resident_kib) / 1024;
  account.threads = static_cast<int>(number_in(folder / "status", "Threads:"));
  account.files = count_in(folder / "fd");
  account.locked_mib = static_cast<double>(number_in(folder / "status", "VmLck:")) / 1024;
  const Stat stat = read_stat(folder / "stat");
  account.minor_faults = stat.minor_faults;
  account.major_faults = stat.major_faults;
  return account;
}

std::vector<ThreadAccount> threads_of(pid_t process) {
  std::vector<ThreadAccount> all;
  std::error_code gone;
  const fs::path tasks = fs::path("/proc") / std::to_string(process) / "task";
  for (fs::directory_iterator at(tasks, gone), end; !gone && at != end; at.increment(gone)) {
    const fs::path status = at->path() / "status";
    const Stat stat = read_stat(at->path() / "stat");
    all.push_back({.name = text_in(status, "Name:"),
                   .processors = text_in(status, "Cpus_allowed_list:"),
                   .id = static_cast<pid_t>(number_in(status, "Pid:")),
                   .policy = stat.policy,
                   .priority = stat.priority,
                   .minor_faults = stat.minor_faults,
                   .major_faults = stat.major_faults,
                   .voluntary_switches = number_in(status, "voluntary_ctxt_switches:"),
                   .involuntary_switches = number_in(status, "nonvoluntary_ctxt_switches:")});
    if (all.back().id == 0) all.pop_back();  // it ended meanwhile
  }
  return all;
}

std::string scheduling_text(const ThreadAccount& thread) {
  if (thread.policy == SCHED_FIFO) return "FIFO " + std::to_string(thread.priority);
  if (thread.policy == SCHED_RR) return "RR " + std::to_string(thread.priority);
  if (thread.policy == SCHED_IDLE) return "idle";
  return thread.policy == SCHED_OTHER ? "normal" : "class " + std::to_string(thread.policy);
}

}  // namespace meridian::process
