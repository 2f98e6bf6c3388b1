// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/judge.hpp"

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

Judge::Judge(const MachineModel& model, const ToolTable& tools, std::filesystem::path folder,
             const std::filesystem::path& kept)
    : model_(model),
      tools_(tools),
      folder_(std::move(folder)),
      kept_(kept, "recording", kMostKept),
      segments_(folder_, [this](const Segment& segment) {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(segment);
      }) {
  if (::mkfifo(pipe().c_str(), 0600) != 0) {
    throw std::runtime_error(pipe().string() + " cannot be made");
  }
  reader_ = std::thread([this] { read_pipe(); });
  checker_ = std::thread([this] { judge_segments(); });
}

Judge::~Judge() { finish(); }

void Judge::announce(const std::string& program, bool is_ours, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  programs_.announce(program, is_ours, now_ns);
}

void Judge::announce_override(double factor, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  overrides_.announce(factor, now_ns);
}

void Judge::read_pipe() {
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

void Judge::judge_segments() {
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
    Judged judged = judge(segment);
    keep(judged, segment);
    std::error_code ignored;
    std::filesystem::remove(segment.file, ignored);
    lock.lock();
    judged_.push_back(std::move(judged));
  }
}

Judge::Judged Judge::judge(const Segment& segment) {
  Judged judged;
  record::CheckedPath path(model_.tool_length_mm, model_.max_feed_mm_per_s);
  std::string program;
  double most_override = 1;
  if (segment.has_run) {
    const std::lock_guard lock(mutex_);
    programs_.forget_before(segment.begin_ns);
    overrides_.forget_before(segment.begin_ns);
    program = programs_.at(segment.begin_ns);
    most_override = overrides_.most_since(segment.begin_ns);
  }
  judged.where = program.empty() ? "no program" : program;
  if (!program.empty()) {
    judged.refusal = record::read_path(program, {}, tools_, path);
  }
  auto recording = record::RecordingReader::open(segment.file.string(), model_);
  if (!recording) {
    judged.refusal = recording.error().text();
    return judged;
  }
  record::CheckOptions options;
  options.max_missing = std::numeric_limits<std::uint64_t>::max();
  options.feed_factor = most_override;
  options.allow_unfinished = segment.is_aborted;
  auto report = record::check(*recording, path, model_, options);
  if (report) {
    judged.check = std::move(*report);
  } else {
    judged.refusal = report.error().text();
  }
  return judged;
}

void Judge::keep(Judged& judged, const Segment& segment) {
  if (judged.refusal.empty() && judged.check.findings.empty()) return;
  const std::string kept = kept_.keep({{segment.file, ".csv"}, {judged.where, ".cl"}});
  if (!kept.empty()) judged.where = kept + ".csv";
}

void Judge::collect(SoakReport& report) {
  std::vector<Judged> judged;
  {
    const std::lock_guard lock(mutex_);
    judged.swap(judged_);
  }
  for (const Judged& one : judged) {
    if (one.refusal.empty()) {
      report.add(one.check, one.where);
    } else {
      ++report.segments_unread;
      report.violate("a recording cannot be judged: " + one.refusal, one.where);
    }
  }
}

void Judge::finish() {
  is_ending_ = true;
  if (reader_.joinable()) reader_.join();
  if (checker_.joinable()) checker_.join();
}

}  // namespace meridian::soak
