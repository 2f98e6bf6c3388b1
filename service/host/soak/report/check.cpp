// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/check.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "service/recording/record/check/check.hpp"
#include "service/recording/record/file/read_path.hpp"

namespace meridian::soak {
namespace {

constexpr auto kLook = std::chrono::milliseconds(5);

}  // namespace

Check::Check(const MachineModel& model, const ToolTable& tools, std::filesystem::path folder,
             const std::filesystem::path& kept)
    : model_(model),
      tools_(tools),
      folder_(std::move(folder)),
      kept_(kept, "recording", kMaxKept),
      segments_(folder_, [this](const Segment& segment) {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(segment);
      }) {
  if (::mkfifo(pipe().c_str(), 0600) != 0) {
    throw std::runtime_error(pipe().string() + " cannot be made");
  }
  reader_ = std::thread([this] { read_pipe(); });
  checker_ = std::thread([this] { check_segments(); });
}

Check::~Check() { finish(); }

void Check::announce(const std::string& program, bool is_ours, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  programs_.announce(program, is_ours, now_ns);
}

void Check::announce_override(double factor, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  overrides_.announce(factor, now_ns);
}

void Check::read_pipe() {
  const int file = ::open(pipe().c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  constexpr int kPipe_bytes = 1 << 20;
  (void)::fcntl(file, F_SETPIPE_SZ, kPipe_bytes);
  std::array<char, 65536> part{};
  bool has_data = false;
  for (;;) {
    const bool is_last = is_ending_;
    const ssize_t got = ::read(file, part.data(), part.size());
    if (got > 0) {
      segments_.add({part.data(), static_cast<std::size_t>(got)});
      has_data = true;
      continue;
    }
    if (got == 0 && std::exchange(has_data, false)) segments_.cut_off();  // the service is gone
    if (is_last) break;
    std::this_thread::sleep_for(kLook);
  }
  ::close(file);
  is_read_ = true;
}

void Check::check_segments() {
  for (;;) {
    const bool is_last = is_read_;
    std::unique_lock lock(mutex_);
    if (waiting_.empty()) {
      lock.unlock();
      if (is_last) return;
      std::this_thread::sleep_for(kLook);
      continue;
    }
    const Segment segment = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    Checked checked = check(segment);
    keep(checked, segment);
    std::error_code ignored;
    std::filesystem::remove(segment.file, ignored);
    lock.lock();
    checked_.push_back(std::move(checked));
  }
}

Check::Checked Check::check(const Segment& segment) {
  Checked checked;
  record::CheckedPath path(model_.tool_length_mm, model_.max_feed_mm_per_s);
  std::string program;
  double max_override = 1;
  if (segment.has_run) {
    const std::lock_guard lock(mutex_);
    programs_.forget_before(segment.begin_ns);
    overrides_.forget_before(segment.begin_ns);
    program = programs_.at(segment.begin_ns);
    max_override = overrides_.max_since(segment.begin_ns);
  }
  checked.where = program.empty() ? "no program" : program;
  if (!program.empty()) {
    checked.refusal = record::read_path(program, {}, tools_, path);
  }
  auto recording = record::RecordingReader::open(segment.file.string(), model_);
  if (!recording) {
    checked.refusal = recording.error().text();
    return checked;
  }
  record::CheckOptions options;
  options.max_missing = std::numeric_limits<std::uint64_t>::max();
  options.feed_factor = max_override;
  options.allow_unfinished = segment.is_aborted;
  auto report = record::check(*recording, path, model_, options);
  if (report) {
    checked.check = std::move(*report);
  } else {
    checked.refusal = report.error().text();
  }
  return checked;
}

void Check::keep(Checked& checked, const Segment& segment) {
  if (checked.refusal.empty() && checked.check.findings.empty()) return;
  const std::string kept = kept_.keep({{segment.file, ".csv"}, {checked.where, ".cl"}});
  if (!kept.empty()) checked.where = kept + ".csv";
}

void Check::collect(SoakReport& report) {
  std::vector<Checked> checked;
  {
    const std::lock_guard lock(mutex_);
    checked.swap(checked_);
  }
  for (const Checked& one : checked) {
    if (one.refusal.empty()) {
      report.add(one.check, one.where);
    } else {
      ++report.segments_unread;
      report.violate("a recording cannot be checked: " + one.refusal, one.where);
    }
  }
}

void Check::finish() {
  is_ending_ = true;
  if (reader_.joinable()) reader_.join();
  if (checker_.joinable()) checker_.join();
}

}  // namespace meridian::soak
