// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/flight_recorder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <exception>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/flight/flight_writer.hpp"
#include "service/recording/record/words.hpp"
#include "service/recording/telemetry/file_name.hpp"
#include "service/recording/telemetry/words.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::telemetry {
namespace {

namespace fs = std::filesystem;

constexpr double kTail_s = 0.5;
/// The rows are at most so large: the service locks its memory, and all of it has to do with
/// resident_memory of the budgets (this room reads no file of the project; a test compares).
constexpr std::size_t kRows_bytes = std::size_t{3} << 20U;
constexpr const char* kPrefix = "fault-";

[[nodiscard]] std::size_t rows_of(double time_s, const MachineModel& model) {
  return static_cast<std::size_t>(time_s * 1e9 / static_cast<double>(model.cycle_ns));
}

[[nodiscard]] std::size_t rows_that_fit(double time_s, const MachineModel& model) {
  return std::min(rows_of(time_s, model), kRows_bytes / sizeof(record::FlightRow));
}

/// Whether a file has a name that this recorder gives: fault-20260412T081530. and `ending`.
[[nodiscard]] bool is_ours(const fs::path& file, std::string_view ending) {
  constexpr std::string_view kShape = "fault-00000000T000000.";
  const std::string name = file.filename().string();
  if (name.size() < kShape.size() || !name.ends_with(ending)) return false;
  for (std::size_t i = 0; i < kShape.size(); ++i) {
    const bool is_digit = std::isdigit(static_cast<unsigned char>(name[i])) != 0;
    if (kShape[i] == '0' ? !is_digit : name[i] != kShape[i]) return false;
  }
  return true;
}

/// The files of this recorder in `folder`, the oldest first.
[[nodiscard]] std::vector<fs::path> find_ours(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (is_ours(at->path(), ending)) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// When a due time of the cycle was, by the calendar, UTC.
[[nodiscard]] std::string calendar(std::int64_t due_ns, const char* format) {
  using std::chrono::duration_cast;
  using std::chrono::milliseconds;
  const auto age =
      std::chrono::steady_clock::now().time_since_epoch() - std::chrono::nanoseconds(due_ns);
  const auto then = std::chrono::system_clock::now().time_since_epoch() - age;
  const std::int64_t total_ms = duration_cast<milliseconds>(then).count();
  const std::time_t seconds = total_ms / 1000;
  std::tm parts{};
  char text[64] = "";
  if (::gmtime_r(&seconds, &parts) != nullptr)
    (void)std::strftime(text, sizeof text, format, &parts);
  return fmt::format("{}.{:03}", text, total_ms % 1000);
}

[[nodiscard]] record::ReportedAlarm reason(const FlightStore& store) {
  return store.alarm_count() > 0 ? store.alarm(0) : record::ReportedAlarm{};
}

/// "following_error-b3": what a file's name says of an alarm.
[[nodiscard]] std::string name_of_file(const record::ReportedAlarm& alarm,
                                       const MachineModel& model) {
  std::string name(record::word(alarm.alarm));
  if (record::is_of_joint(alarm.alarm) && alarm.joint >= 0 && alarm.joint < limited_count(model)) {
    name += "-" + limited_spec(model, alarm.joint).name;
  }
  return plain_name(name);
}

/// The folder, made where it is not there; none, which the log says, where it cannot be written to.
[[nodiscard]] fs::path make_writable(const fs::path& folder, spdlog::logger& log) {
  if (folder.empty()) return folder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && ::access(folder.c_str(), W_OK | X_OK) != 0) {
    error = std::error_code(errno, std::generic_category());
  }
  if (!error) return folder;
  log.error(
      "the flight recorder cannot write to {}, faults leave no record: {}; name a folder "
      "that is writable",
      folder.string(), error.message());
  return {};
}

[[nodiscard]] fs::path with_ending(fs::path file, const char* ending) {
  return file.replace_extension(ending);
}

}  // namespace

fs::path default_fault_folder(const fs::path& state, const std::string& machine) {
  return state.empty() ? fs::path() : state / "faults" / plain_name(machine);
}

FlightRecorder::FlightRecorder(const config::FlightConfig& config, const MachineModel& model,
                               std::shared_ptr<spdlog::logger> log)
    : folder_(make_writable(config.folder, *log)),
      max_faults_(static_cast<std::size_t>(config.faults)),
      model_(model),
      log_(std::move(log)),
      store_(is_on() ? rows_that_fit(config.seconds, model) : 0, rows_of(kTail_s, model)) {
  if (!is_on() || store_.room() >= rows_of(config.seconds, model)) return;
  log_->warn(
      "the flight recorder keeps the last {:.1f} s, not {} s: more rows of {} us do not "
      "fit into its {} MiB",
      static_cast<double>(store_.room()) * 1e-9 * static_cast<double>(model.cycle_ns),
      config.seconds, model.cycle_ns / 1000, kRows_bytes >> 20U);
}

void FlightRecorder::take(const Event& event) noexcept {
  store_.take(event, weight_of(event) != Weight::kDetail);
}

void FlightRecorder::run() noexcept {
  if (!is_on()) return;
  remove_torn();
  for (bool is_last = false; !is_last;) {
    is_last = is_stopping_.load();
    if (store_.is_frozen()) {
      try {
        write();
      } catch (const std::exception& error) {
        log_->error("flight recorder: {}", error.what());
      }
      store_.thaw();
    } else if (!is_last) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
}

void FlightRecorder::report_missed() noexcept {
  const std::uint64_t missed = faults_missed();
  if (missed == reported_missed_) return;
  log_->warn(
      "{} faults have no record of their own: one before was still being recorded or written",
      missed - reported_missed_);
  reported_missed_ = missed;
}

void FlightRecorder::write() {
  const std::int64_t due_ns = store_.fault().record.setpoint.due_ns;
  const std::string stem =
      kPrefix + calendar(due_ns, "%Y%m%dT%H%M%S") + "Z-" + name_of_file(reason(store_), model_);
  fs::path file = folder_ / (stem + ".csv");
  std::error_code error;
  for (int n = 2; fs::exists(file, error); ++n) {
    file = folder_ / (stem + "-" + std::to_string(n) + ".csv");
  }
  std::string trouble = write_rows(file);
  if (trouble.empty()) trouble = write_words(file, calendar(due_ns, "%Y-%m-%d %H:%M:%S"));
  if (trouble.empty()) {
    log_->warn("what was sent and reported around the fault is in {}", file.string());
  } else {
    log_->error("the record of the fault is lost or cut off: {}", trouble);
  }
  remove_old(file);
}

/// Under another name until it is whole. Returns what went wrong.
std::string FlightRecorder::write_rows(const fs::path& file) const {
  const fs::path part = file.string() + ".part";
  auto writer = record::FlightWriter::create(part, model_);
  if (!writer) return writer.error().text();
  const record::ReportedAlarm why = reason(store_);
  for (std::size_t i = 0; i < store_.size(); ++i) {
    const record::FlightRow& row = store_.row(i);
    const bool is_reported = row.record.setpoint.cycle >= why.cycle;
    if (!writer->write(row, is_reported ? why : record::ReportedAlarm{})) break;
  }
  std::error_code error;
  if (!writer->close()) {
    const std::string text = part.string() + ": " + std::strerror(writer->error_number());
    fs::remove(part, error);
    return text;
  }
  fs::rename(part, file, error);
  return error ? file.string() + ": " + error.message() : "";
}

std::string FlightRecorder::write_words(const fs::path& file, const std::string& when) const {
  const CycleRecord& fault = store_.fault().record;
  const double cycle_s = static_cast<double>(model_.cycle_ns) * 1e-9;
  const auto since = [&](std::uint64_t cycle) {
    return cycle_s * static_cast<double>(static_cast<std::int64_t>(cycle - fault.setpoint.cycle));
  };
  const fs::path words = with_ending(file, ".txt");
  std::ostringstream out;
  out << "machine " << model_.name << ", fault of " << when << " UTC, cycle "
      << fault.setpoint.cycle << ", block " << fault.sequence << " of line " << fault.setpoint.line
      << "\n\n";
  if ((fault.setpoint.flags & kSetpointDry) != 0) out << "dry run: no drive followed\n\n";
  if (store_.alarm_count() == 0) out << "its alarm is not known\n";
  for (std::size_t i = 0; i < store_.alarm_count(); ++i) {
    const record::ReportedAlarm& alarm = store_.alarm(i);
    out << fmt::format("{:+9.3f} s  {}\n", since(alarm.cycle),
                       describe(alarm.alarm, alarm.joint, alarm.value, alarm.line, model_));
  }
  out << "\nevents of the machine, seconds from the fault:\n\n";
  for (std::size_t i = 0; i < store_.event_count(); ++i) {
    const Event& event = store_.event(i);
    out << fmt::format("{:+9.3f} s  {}\n", since(event.cycle), describe(event, model_));
  }
  out << "\nevery cycle: " << file.filename().string() << "\n";
  if (faults_missed() > 0) {
    out << "faults since the start whose record found no room: " << faults_missed() << "\n";
  }
  const int error = text::write_anew(words, out.str());
  return error == 0 ? "" : words.string() + ": " + std::strerror(error);
}

/// What a service was killed over.
void FlightRecorder::remove_torn() const {
  std::error_code ignored;
  for (const fs::path& part : find_ours(folder_, ".csv.part")) fs::remove(part, ignored);
}

/// The oldest go, by the time in their names; the newest stays whatever the calendar says.
void FlightRecorder::remove_old(const fs::path& newest) const {
  std::vector<fs::path> files = find_ours(folder_, ".csv");
  std::erase(files, newest);
  std::error_code error;
  const std::size_t max_others = max_faults_ - 1;
  for (std::size_t i = 0; i + max_others < files.size(); ++i) {
    fs::remove(files[i], error);
    fs::remove(with_ending(files[i], ".txt"), error);
  }
}

}  // namespace meridian::telemetry
