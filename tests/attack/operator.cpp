// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <sstream>
#include <string>

#include "attack/modes.hpp"
#include "attack/observer.hpp"

/// The honest operator of a campaign, against idl/ and docs/topics.md alone. It reads lines:
///
///   say VERB [ARGUMENT]     a verb (number of meridian::Verb), as one who has just looked
///   stop VERB LIMIT_MS [cruise]   the same, measured; cruise: as soon as the speed is constant
///   jog JOINT VELOCITY      holds a joint, 50 samples a second; velocity 0 lets go
///   renumber N              the next request is N, as of a panel that was restarted
///   report                  what was seen
///
/// and prints a JSON object a line: states, replies, measurements, reports.
namespace attack {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::uint8_t kHold = 3, kAbort = 5;

/// A stop that is on its way.
struct Measurement {
  int verb;
  std::int64_t limit_ns;
  bool waits_for_cruise;
  std::uint64_t request = 0;
  std::int64_t asked_ns, written_ns = 0, returned_ns = 0, state_ns = 0, reply_ns = 0;
  std::int64_t slower_due_ns = 0;
  double reference = 0;  ///< speed when it was said; 0: not constant then
  std::uint8_t state_before = 0;
};

class Operator {
 public:
  Operator(const Wire& wire, const Options& options)
      : observer_(wire, options.service_process, options.drives_process),
        commands_(wire.writer(topic_named("command"))),
        jogs_(wire.writer(topic_named("jog"))),
        replies_(wire.reader(topic_named("reply"))),
        id_(options.operator_id != 0 ? options.operator_id : std::random_device()() | 1ULL << 40U) {
  }

  /// Until its input ends or time is over.
  void run(double duration_s) {
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(1e9 * duration_s);
    while (monotonic_ns() < end_ns && read_lines()) {
      observer_.poll();
      report_state();
      take_replies();
      hold_joint();
      measure();
      std::fflush(stdout);
    }
  }

 private:
  bool read_lines();
  void obey(const std::string& line);
  std::uint64_t write_command(int verb, double argument);
  void report_state();
  void take_replies();
  void hold_joint();
  void measure();
  void end_measurement();
  void report();
  [[nodiscard]] bool has_stopped(const Measurement& one) const;

  Observer observer_;
  dds_entity_t commands_, jogs_, replies_;
  std::uint64_t id_, request_ = 0, jog_sample_ = 0, reported_sequence_ = 0;
  int reported_state_ = -1;
  std::string input_;
  std::optional<Measurement> measurement_;
  int joint_ = 0;
  double velocity_ = 0;
  bool is_holding_joint_ = false;
  std::int64_t next_jog_ns_ = 0;
};

bool Operator::read_lines() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 1) <= 0) return true;
  char buffer[1024];
  const ssize_t got = ::read(STDIN_FILENO, buffer, sizeof buffer);
  if (got <= 0) return false;
  input_.append(buffer, static_cast<std::size_t>(got));
  for (auto end = input_.find('\n'); end != std::string::npos; end = input_.find('\n')) {
    obey(input_.substr(0, end));
    input_.erase(0, end + 1);
  }
  return true;
}

void Operator::obey(const std::string& line) {
  std::istringstream words(line);
  std::string what, how;
  double first = 0, second = 0;
  words >> what >> first >> second >> how;
  if (what == "say") {
    const std::uint64_t request = write_command(static_cast<int>(first), second);
    std::printf("{\"said\": %d, \"request\": %llu}\n", static_cast<int>(first),
                static_cast<unsigned long long>(request));
  } else if (what == "stop") {
    measurement_ = Measurement{.verb = static_cast<int>(first),
                               .limit_ns = static_cast<std::int64_t>(second) * kMillisecond_ns,
                               .waits_for_cruise = how == "cruise",
                               .asked_ns = monotonic_ns()};
  } else if (what == "jog") {
    joint_ = static_cast<int>(first);
    velocity_ = second;
    is_holding_joint_ = true;
    next_jog_ns_ = 0;
  } else if (what == "letgo") {
    is_holding_joint_ = false;
  } else if (what == "renumber") {
    request_ = static_cast<std::uint64_t>(first) - 1;
  } else if (what == "report") {
    report();
  }
}

std::uint64_t Operator::write_command(int verb, double argument) {
  meridian_wire_Command command{};
  command.request = ++request_;
  command.operator_id = id_;
  std::strcpy(command.operator_name, "honest");
  command.verb = static_cast<std::uint8_t>(verb);
  command.epoch_seen = observer_.status().epoch;
  command.status_seen = observer_.status().status_sequence;
  command.service_id_seen = observer_.status().service_id;
  command.argument = argument;
  (void)dds_write(commands_, &command);
  return command.request;
}

void Operator::report_state() {
  const auto& status = observer_.status();
  if (!observer_.has_status() || status.state == reported_state_) return;
  reported_state_ = status.state;
  std::printf(
      "{\"state\": %d, \"epoch\": %d, \"alarm\": %d, \"line\": %u, \"session\": %llu, "
      "\"at_ns\": %lld}\n",
      status.state, status.epoch, status.alarm, status.line,
      static_cast<unsigned long long>(status.session),
      static_cast<long long>(observer_.status_ns()));
}

void Operator::take_replies() {
  meridian_wire_Reply reply;
  void* samples[1] = {&reply};
  dds_sample_info_t info;
  while (dds_take(replies_, samples, &info, 1, 1) == 1) {
    if (!info.valid_data || reply.operator_id != id_ ||
        !observer_.is_of_service(replies_, info.publication_handle)) {
      continue;
    }
    const bool is_answer =
        measurement_ && measurement_->request == reply.request && measurement_->verb == reply.verb;
    if (is_answer && measurement_->reply_ns == 0) measurement_->reply_ns = monotonic_ns();
    std::printf("{\"reply\": %llu, \"verb\": %d, \"accepted\": %d, \"refusal\": %d}\n",
                static_cast<unsigned long long>(reply.request), reply.verb, reply.is_accepted,
                reply.refusal);
  }
}

void Operator::hold_joint() {
  const std::int64_t now_ns = monotonic_ns();
  if (!is_holding_joint_ || now_ns < next_jog_ns_) return;
  next_jog_ns_ = now_ns + 20 * kMillisecond_ns;
  meridian_wire_Jog jog{};
  jog.operator_id = id_;
  jog.sample = ++jog_sample_;
  jog.status_seen = observer_.status().status_sequence;
  jog.service_id_seen = observer_.status().service_id;
  jog.epoch_seen = observer_.status().epoch;
  jog.joint = static_cast<std::uint8_t>(joint_);
  jog.velocity = velocity_;
  jog.dead_man_ns = 300 * kMillisecond_ns;
  (void)dds_write(jogs_, &jog);
}

/// By the status: which states a machine goes to where it obeys that stop.
bool Operator::has_stopped(const Measurement& one) const {
  constexpr std::uint8_t kReady = 2, kHolding = 6, kHeld = 7, kAborting = 10;
  const std::uint8_t state = observer_.status().state;
  const bool is_new = observer_.status_ns() > one.written_ns && state != one.state_before;
  const bool is_aborted = state == kAborting || state == kReady;
  return is_new &&
         (one.verb == kAbort ? is_aborted : is_aborted || state == kHolding || state == kHeld);
}

void Operator::measure() {
  if (!measurement_) return;
  Measurement& one = *measurement_;
  const std::int64_t now_ns = monotonic_ns();
  if (one.request == 0) {
    const bool is_late = now_ns - one.asked_ns > 3'000 * kMillisecond_ns;
    if (one.waits_for_cruise && !observer_.is_cruising() && !is_late) return;
    one.reference = observer_.is_cruising() ? observer_.speed() : 0;
    one.state_before = observer_.status().state;
    one.written_ns = monotonic_ns();
    one.request = write_command(one.verb, 0);
    one.returned_ns = monotonic_ns();
    return;
  }
  if (one.reference > 0 && one.slower_due_ns == 0) {
    one.slower_due_ns = observer_.slower_since(one.written_ns, one.reference);
  }
  if (one.state_ns == 0 && has_stopped(one)) one.state_ns = observer_.status_ns();
  const bool is_seen = one.state_ns != 0 && (one.reference == 0 || one.slower_due_ns != 0);
  if (is_seen || now_ns - one.written_ns > one.limit_ns) end_measurement();
}

void Operator::end_measurement() {
  const Measurement& one = *measurement_;
  std::printf(
      "{\"measured\": %d, \"request\": %llu, \"written_ns\": %lld, \"returned_ns\": %lld, "
      "\"slower_due_ns\": %lld, \"state_ns\": %lld, \"reply_ns\": %lld, "
      "\"state_before\": %d, \"state\": %d, \"is_cruising\": %d}\n",
      one.verb, static_cast<unsigned long long>(one.request),
      static_cast<long long>(one.written_ns), static_cast<long long>(one.returned_ns),
      static_cast<long long>(one.slower_due_ns), static_cast<long long>(one.state_ns),
      static_cast<long long>(one.reply_ns), one.state_before, observer_.status().state,
      one.reference > 0 ? 1 : 0);
  measurement_.reset();
}

void Operator::report() {
  const auto& account = observer_.account();
  const auto print = [](const char* name, const std::array<double, 6>& moved) {
    std::printf(", \"%s\": [%.6f, %.6f, %.6f, %.6f, %.6f]", name, moved[0], moved[1], moved[2],
                moved[3], moved[4]);
  };
  const auto count = [](const char* name, std::uint64_t value) {
    std::printf(", \"%s\": %llu", name, static_cast<unsigned long long>(value));
  };
  std::printf("{\"report\": 1");
  count("setpoints", account.setpoints);
  count("strangers_setpoints", account.strangers_setpoints);
  count("followed", account.followed);
  count("reports", account.reports);
  count("enabled_at_rest", account.enabled_at_rest);
  print("moved_ready", account.moved_ready);
  print("moved_off", account.moved_off);
  print("moved_fault", account.moved_fault);
  std::printf(", \"off_ms\": [");
  for (std::size_t i = 0; i < account.off_ms.size(); ++i) {
    std::printf("%s%.3f", i == 0 ? "" : ", ", account.off_ms[i]);
  }
  std::printf("]}\n");
}

}  // namespace

int operate(const Options& options) {
  const Wire wire(options.domain, options.machine, options.lease_s);
  Operator one(wire, options);
  one.run(options.duration_s);
  return 0;
}

}  // namespace attack
