// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/set_up_file.hpp"

#include <utility>

#include "service/recording/telemetry/file_name.hpp"
#include "service/recording/telemetry/journal/sealed_text.hpp"

namespace meridian::telemetry {

SetUpFile::SetUpFile(const std::filesystem::path& folder, std::string machine, Journal::Write write)
    : machine_(std::move(machine)), write_(std::move(write)) {
  if (!folder.empty()) path_ = folder / (plain_name(machine_) + ".setup");
}

Expected<SetUp, std::string> SetUpFile::read() {
  if (path_.empty()) return SetUp();
  const auto text = read_small_file(path_, kMaxSetUpBytes);
  if (!text) return tl::make_unexpected(text.error());
  if (!*text) return SetUp();
  auto set_up = parse_set_up(**text, machine_);
  if (set_up) written_ = *set_up;
  return set_up;
}

void SetUpFile::ask(const SetUp& set_up) {
  asked_ = set_up;
  progress_.store(Progress::kAsked, std::memory_order_release);
}

SetUpFile::Progress SetUpFile::look() noexcept {
  const Progress progress = progress_.load(std::memory_order_acquire);
  if (progress != Progress::kAsked) progress_.store(Progress::kNone, std::memory_order_relaxed);
  return progress;
}

void SetUpFile::work() noexcept {
  if (progress_.load(std::memory_order_acquire) != Progress::kAsked) return;
  error_ = write_(path_, to_text(asked_, machine_));
  if (error_ == 0) {
    written_ = asked_;
  } else {
    // Its folder may not have been synced: what is acknowledged is what a restart finds.
    (void)write_(path_, to_text(written_, machine_));
  }
  progress_.store(error_ == 0 ? Progress::kWritten : Progress::kFailed, std::memory_order_release);
}

}  // namespace meridian::telemetry
