// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <utility>

#include "service/host/soak/soak_run.hpp"

/// The operator of a run, and what goes wrong on purpose. Part of SoakRun.
namespace meridian::soak {
namespace {

constexpr std::chrono::milliseconds kAnswer{1500};
/// So often is asked for what leads on and the state stays, until the drives are started anew.
constexpr int kMaxInVain = 15;
/// Between the end of a program and the next: its recording is cut there.
constexpr double kPause_s = 0.3;

}  // namespace

void SoakRun::break_off() {
  lose_station();
  ask(Verb::kAbort);
  start_drives();
}

void SoakRun::operate(const dds::Status& status) {
  const double now = now_s();
  if (now < ask_again_s_) return;
  switch (status.state) {
    case State::kOff:
      lead_on(status.drives_fault_mask != 0 ? Verb::kReset : Verb::kEnable);
      break;
    case State::kFault:
      if (!watch_.faults().is_checked()) break;
      if (std::exchange(is_drive_sick_, false)) start_drives();
      lead_on(Verb::kReset);
      break;
    case State::kReady:
      if (plant_.station() == nullptr && now - ended_s_ > kPause_s) start_program();
      break;
    case State::kLoaded:
      ask(Verb::kStart);
      break;
    case State::kHeld:
      if (now >= resume_s_) ask(Verb::kResume);
      break;
    case State::kStarved:
      if (plant_.station() == nullptr) ask(Verb::kAbort);
      break;
    default:
      break;
  }
}

bool SoakRun::ask(Verb verb, double value) {
  const auto reply = operator_.ask(verb, value, kAnswer);
  ask_again_s_ = now_s() + 0.2;
  report_.asks_unanswered += reply ? 0 : 1;
  report_.asks_refused += reply && !reply->is_accepted ? 1 : 0;
  return reply && reply->is_accepted;
}

void SoakRun::lead_on(Verb verb) {
  ask(verb);
  if (++asked_in_vain_ >= kMaxInVain) start_drives();
}

void SoakRun::mishaps() {
  const double now = now_s();
  if (continue_s_ > 0 && now >= continue_s_ && plant_.station() != nullptr) {
    plant_.station()->send_signal(SIGCONT);
    continue_s_ = 0;
  }
  if (!next_ || now < next_->at_s || state_ != State::kRunning) return;
  if (happen(*next_)) ++report_.mishaps[static_cast<std::size_t>(next_->mishap)];
  do {
    next_ = chaos_.next();
  } while (next_->at_s < now);
}

bool SoakRun::happen(const Planned& mishap) {
  switch (mishap.mishap) {
    case Mishap::kHold:
      resume_s_ = now_s() + mishap.value;
      return ask(Verb::kHold);
    case Mishap::kOverride:
      check_.announce_override(mishap.value, stream::steady_ns());
      return ask(Verb::kFeedOverride, mishap.value);
    case Mishap::kAbort:
      return ask(Verb::kAbort);
    case Mishap::kStationStops:
      if (plant_.station() == nullptr) return false;
      plant_.station()->send_signal(SIGSTOP);
      continue_s_ = now_s() + mishap.value;
      return true;
    case Mishap::kStationDies:
      if (plant_.station() == nullptr) return false;
      lose_station();
      return true;
    case Mishap::kServiceDies:
      plant_.kill_service();
      lose_station();
      service_at_s_ = now_s() + kAfterDeath_s;
      state_ = State::kOff;
      return true;
    default:
      return false;  // those of the drives happen there
  }
}

}  // namespace meridian::soak
