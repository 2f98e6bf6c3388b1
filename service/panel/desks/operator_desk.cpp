// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/operator_desk.hpp"

#include <utility>

#include "meridian/cycle/state_table.hpp"

namespace meridian::panel {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 2000ms;
/// What waited longer than this was said to a machine of another moment.
constexpr auto kWaited = 500ms;

[[nodiscard]] Outcome outcome_of(const std::optional<dds::Reply>& reply) {
  if (!reply) return {false, "the machine does not answer"};
  return {reply->is_accepted, reply->text};
}

[[nodiscard]] Outcome outcome_of(const stream::JogResult& result) {
  switch (result.end) {
    case stream::JogEnd::kNoAnswer:
      return {false, "the machine does not answer"};
    case stream::JogEnd::kRefused:
      return {false, result.text};
    case stream::JogEnd::kTakenOff:
      return {false, "the machine stopped jogging: " + result.text};
    case stream::JogEnd::kDone:
      break;
  }
  if (result.has_moved) return {true, ""};
  return {false, "nothing moved: it stands at the end of its travel, or was held too shortly"};
}

/// Lets go of a grip whose page fell silent, from a thread that does nothing else.
class GripWatch {
 public:
  explicit GripWatch(JogGrip& grip) : grip_(grip), thread_([this] { run(); }) {}
  ~GripWatch() {
    is_ending_ = true;
    thread_.join();
  }
  GripWatch(const GripWatch&) = delete;
  GripWatch& operator=(const GripWatch&) = delete;

 private:
  void run() {
    while (!is_ending_) {
      grip_.check(JogGrip::Clock::now());
      std::this_thread::sleep_for(10ms);
    }
  }
  JogGrip& grip_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace

OperatorDesk::Lane::Lane(dds::Participant& participant, const std::string& operator_name)
    : link_(participant, operator_name), thread_([this] { run(); }) {}

OperatorDesk::Lane::~Lane() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  added_.notify_all();
  thread_.join();
}

bool OperatorDesk::Lane::add(Task task) {
  const std::lock_guard lock(mutex_);
  if (tasks_.size() >= kMaxTasks) return false;
  tasks_.push_back(std::move(task));
  added_.notify_all();
  return true;
}

void OperatorDesk::Lane::run() {
  for (;;) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      added_.wait_for(lock, 100ms, [this] { return is_ending_ || !tasks_.empty(); });
      if (is_ending_) return;
      if (!tasks_.empty()) {
        task = std::move(tasks_.front());
        tasks_.pop_front();
      }
    }
    if (task) {
      task(link_);
    } else {
      static_cast<void>(link_.wait_for_status(0ms));
    }
  }
}

OperatorDesk::OperatorDesk(dds::Participant& participant, const std::string& operator_name)
    : participant_(participant),
      stops_(participant, operator_name),
      others_(participant, operator_name) {}

OperatorDesk::~OperatorDesk() {
  const std::lock_guard lock(mutex_);
  if (const auto grip = grip_.lock()) grip->let_go();
}

void OperatorDesk::ask(Verb verb, double argument, const stream::Seen& seen, OnOutcome on_outcome) {
  if (is_stop(verb)) {
    const std::lock_guard lock(mutex_);
    if (const auto grip = grip_.lock()) grip->let_go();
  }
  const auto said = JogGrip::Clock::now();
  Task task = [verb, argument, seen, said, on_outcome](stream::OperatorLink& link) {
    const bool is_late = !is_stop(verb) && JogGrip::Clock::now() - said > kWaited;
    on_outcome(is_late ? Outcome{false, "the panel was busy with what was asked before: ask again"}
                       : outcome_of(link.ask(verb, argument, kPatience, seen)));
  };
  Lane& lane = is_stop(verb) ? stops_ : others_;
  if (!lane.add(std::move(task))) on_outcome({false, "too much was asked at once"});
}

void OperatorDesk::jog(const stream::JogPlan& plan, std::shared_ptr<JogGrip> grip,
                       OnOutcome on_outcome) {
  {
    const std::lock_guard lock(mutex_);
    grip_ = grip;
  }
  Task task = [this, plan, grip = std::move(grip), on_outcome](stream::OperatorLink& link) {
    const GripWatch watch(*grip);
    grip->check(JogGrip::Clock::now());
    if (grip->is_let_go()) return on_outcome({true, ""});
    if (!hand_) hand_ = std::make_unique<stream::JogHand>(participant_, link);
    on_outcome(outcome_of(hand_->jog(plan, grip->is_let_go(), kPatience)));
  };
  if (!others_.add(std::move(task))) on_outcome({false, "too much was asked at once"});
}

}  // namespace meridian::panel
