// SPDX-License-Identifier: Apache-2.0
#include "service/process/account.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace meridian::process {
namespace {

namespace fs = std::filesystem;

/// The number behind `key` in a file of lines "key: number ..."; 0 where there is none.
[[nodiscard]] std::uint64_t number_in(const fs::path& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    std::istringstream words(line.substr(key.size()));
    std::uint64_t number = 0;
    words >> number;
    return number;
  }
  return 0;
}

/// Minor and major faults: fields 10 and 12 of a stat file, counted behind the name in brackets.
void read_faults(const fs::path& path, std::uint64_t& minor, std::uint64_t& major) {
  std::ifstream file(path);
  std::string text;
  std::getline(file, text);
  const auto bracket = text.rfind(')');
  if (bracket == std::string::npos) return;
  std::istringstream words(text.substr(bracket + 1));
  std::string word;
  for (int field = 3; words >> word; ++field) {
    if (field == 10) minor = std::stoull(word);
    if (field == 12) major = std::stoull(word);
  }
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
  read_faults(folder / "stat", account.minor_faults, account.major_faults);
  return account;
}

std::optional<ThreadAccount> account_of(pid_t process, const std::string& thread) {
  std::error_code gone;
  const fs::path tasks = fs::path("/proc") / std::to_string(process) / "task";
  for (const fs::directory_entry& task : fs::directory_iterator(tasks, gone)) {
    std::ifstream name_file(task.path() / "comm");
    std::string name;
    std::getline(name_file, name);
    if (name != thread) continue;
    ThreadAccount account;
    read_faults(task.path() / "stat", account.minor_faults, account.major_faults);
    account.voluntary_switches = number_in(task.path() / "status", "voluntary_ctxt_switches:");
    account.involuntary_switches = number_in(task.path() / "status", "nonvoluntary_ctxt_switches:");
    return account;
  }
  return std::nullopt;
}

}  // namespace meridian::process
