// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "meridian/cycle/state_table.hpp"
#include "support/explore.hpp"

/// The machine as its states and what they hang on, without numbers: the operator's edges are those
/// of the table verb × state itself, the cycle's are written down here and compared with the real
/// step() by machine_model_test.cpp. Everything that can happen in a period is one step.
namespace meridian::test {

/// The table, or one that is wrong on purpose.
using Table = std::function<VerbEffect(State, Verb)>;

inline constexpr int kNoWord = -1;

struct Machine {
  State state = State::kOff;
  bool has_fault = false, is_emergency = false, has_feedback = true;  ///< what the drives report
  bool is_on = false;        ///< every drive reports operation enabled
  int waiting = 0;           ///< pieces in the queue, at most two
  bool has_piece = false;    ///< one is in force
  bool is_moving = false;    ///< the joints are under way
  bool may_go_on = false;    ///< starved for a short time, by the session that is still there
  bool has_session = false;  ///< a station holds the machine
  bool is_granted = false;   ///< ghost: an operator's start or resume stands behind the motion
  bool is_clear = true;      ///< ghost: no fault since the last reset
  bool is_dry_run = false;   ///< drives stay off
  bool is_position_known = false;  ///< ghost: where the joints are was taken from the drives
  int word = kNoWord;      ///< verb that waits for its turn behind others; of these one at a time
  bool is_passed = false;  ///< a stop was said after it, and came first
  std::string wrong{};

  bool operator==(const Machine&) const = default;
  /// Who says that the input is open is still there.
  [[nodiscard]] bool hears_emergency() const { return is_emergency && has_feedback; }
};

[[nodiscard]] inline std::string key_of(const Machine& m) {
  std::string key = name_of(m.state);
  for (const bool b :
       {m.has_fault, m.is_emergency, m.has_feedback, m.is_on, m.has_piece, m.is_moving, m.may_go_on,
        m.has_session, m.is_granted, m.is_clear, m.is_dry_run, m.is_position_known}) {
    key += b ? '1' : '0';
  }
  return key + std::to_string(m.waiting) + (m.is_passed ? 'p' : 'w') + std::to_string(m.word) +
         m.wrong;
}

/// What must hold in every state.
[[nodiscard]] inline std::string complaint_of(const Machine& m) {
  if (!m.wrong.empty()) return m.wrong;
  if (m.is_moving && !is_on_path(m.state)) return "motion in a state of rest";
  if (m.is_moving && !m.is_granted) return "motion that no operator started";
  if (m.is_moving && !m.is_clear && m.state != State::kFaultStop) return "motion after a fault";
  if (is_enabled(m.state) && !m.is_dry_run && !m.is_position_known) {
    return "drives are led from a place that they did not report";
  }
  return "";
}

class OperatedMachine {
 public:
  using Steps = std::vector<Step<Machine>>;
  /// `voids_words`: what a stop goes past does nothing any more.
  explicit OperatedMachine(Table table, bool voids_words = true)
      : table_(std::move(table)), voids_words_(voids_words) {}

  [[nodiscard]] Steps steps(const Machine& m) const {
    Steps all;
    world(m, all);
    periods(m, "a period", all);
    for (int v = 0; v < kVerbCount; ++v) {
      const auto verb = static_cast<Verb>(v);
      // What waits already is ahead of all but stops.
      if (m.word == kNoWord || is_stop(verb)) say(m, verb, all);
      if (m.word == kNoWord && leads_to_motion(verb)) wait(m, verb, all);
    }
    if (m.word != kNoWord) take_word(m, all);
    return all;
  }

  /// Whether operator and drives that mean well bring the machine to Off.
  [[nodiscard]] bool can_be_switched_off(Machine m) const {
    m.has_fault = m.is_emergency = false;
    m.has_feedback = true;
    for (int n = 0; n < 12 && m.state != State::kOff; ++n) {
      m.is_on = is_enabled(m.state) && m.state != State::kEnabling;
      for (const Verb verb : {Verb::kDisable, Verb::kAbort, Verb::kReset}) {
        if (table_(m.state, verb).effect == Effect::kGo) obey(m, verb);
      }
      if (m.state == State::kDisabling) enter(m, State::kOff);
      if (is_stopping(m.state)) arrive(m);
    }
    return m.state == State::kOff;
  }

 private:
  [[nodiscard]] static bool is_stopping(State s) {
    return s == State::kHolding || s == State::kAborting || s == State::kFaultStop;
  }
  static void enter(Machine& m, State next) {
    m.state = next;
    if (!is_on_path(next) && next != State::kStarved) m.is_granted = false;
  }
  static void drop_program(Machine& m) {
    if (m.is_moving) m.wrong = "the program is dropped in motion";
    m.waiting = 0;
    m.has_piece = false;
  }
  static void raise(Machine& m) {
    m.is_clear = false;
    if (m.state != State::kFaultStop) enter_fault_stop(m);
  }
  static void enter_fault_stop(Machine& m) {
    const bool was_granted = m.is_granted;
    enter(m, State::kFaultStop);
    m.is_granted = was_granted;
  }
  static void supervise(Machine& m) {
    if (!is_enabled(m.state)) return;
    const bool is_checked = m.state != State::kEnabling && m.state != State::kFaultStop;
    if (m.is_dry_run) {
      if (m.hears_emergency() || m.is_on) raise(m);
      return;
    }
    if (m.is_emergency || !m.has_feedback || m.has_fault || (is_checked && !m.is_on)) raise(m);
  }
  [[nodiscard]] static bool may_enable(const Machine& m) {
    if (m.is_dry_run) return !m.is_on && !m.hears_emergency();
    return m.has_feedback && !m.is_emergency && !m.has_fault;
  }
  static void set_dry_run(Machine& m) {
    if (!m.is_dry_run && m.is_on) return;
    m.is_dry_run = !m.is_dry_run;
    drop_program(m);
  }
  void obey(Machine& m, Verb verb) const {
    const VerbEffect effect = table_(m.state, verb);
    if (effect.effect == Effect::kSet && verb == Verb::kDryRun) return set_dry_run(m);
    if (effect.effect != Effect::kGo) return;
    if (verb == Verb::kEnable && !may_enable(m)) return;
    if (verb == Verb::kEnable) m.is_position_known = !m.is_dry_run;
    if (verb == Verb::kHome && m.is_dry_run) return;
    if (verb == Verb::kReset && m.hears_emergency()) return;
    if (verb == Verb::kResume && !m.has_piece && m.waiting == 0) return;
    if ((verb == Verb::kJog || verb == Verb::kHome) && m.has_session) return;
    if (verb == Verb::kStart || verb == Verb::kResume || verb == Verb::kJog) m.is_granted = true;
    if (verb == Verb::kReset) m.is_clear = true;
    if (effect.next == State::kDisabling) drop_program(m);
    const bool was_granted = m.is_granted;
    enter(m, effect.next);
    if (is_on_path(effect.next)) m.is_granted = was_granted;
    if (verb == Verb::kResume && !m.has_piece) take_piece(m);
  }
  static void take_piece(Machine& m) {
    --m.waiting;
    m.has_piece = true;
  }
  static void arrive(Machine& m) {
    m.is_moving = false;
    if (m.state == State::kHolding) return enter(m, State::kHeld);
    drop_program(m);
    enter(m, m.state == State::kAborting ? State::kReady : State::kFault);
  }

  /// What comes from outside, whatever the machine does.
  static void world(const Machine& m, Steps& all) {
    const auto add = [&](const char* name, const auto& change) {
      Machine next = m;
      change(next);
      all.push_back({name, next});
    };
    add("drive fault comes or goes", [](Machine& n) { n.has_fault = !n.has_fault; });
    add("emergency input opens or closes", [](Machine& n) { n.is_emergency = !n.is_emergency; });
    add("feedback is lost or back", [](Machine& n) { n.has_feedback = !n.has_feedback; });
    if (m.is_on || is_enabled(m.state)) {
      add("drives switch on or off", [](Machine& n) { n.is_on = !n.is_on; });
    }
    if (m.waiting < 2) add("a block comes", [](Machine& n) { ++n.waiting, n.has_session = true; });
    add("a station comes or goes", [](Machine& n) { n.has_session = !n.has_session; });
    if (m.may_go_on)
      add("time is up, or the session is another", [](Machine& n) { n.may_go_on = false; });
  }
  static void wait(const Machine& m, Verb verb, Steps& all) {
    Machine next = m;
    next.word = static_cast<int>(verb);
    next.is_passed = false;
    all.push_back({std::string(name_of(verb)) + " waits", next});
  }
  void take_word(const Machine& m, Steps& all) const {
    Machine next = m;
    const auto verb = static_cast<Verb>(m.word);
    supervise(next);
    next.word = kNoWord;
    next.is_passed = false;
    if (!m.is_passed || !voids_words_) obey(next, verb);
    if (m.is_passed && next.is_granted && !m.is_granted) next.wrong = "motion from before a stop";
    periods(next, std::string(name_of(verb)) + " has its turn", all);
  }
  void say(const Machine& m, Verb verb, Steps& all) const {
    Machine next = m;
    supervise(next);
    obey(next, verb);
    next.is_passed = next.word != kNoWord && (next.is_passed || is_stop(verb));
    periods(next, name_of(verb), all);
  }
  /// Everything that the cycle may do in one period, in that state.
  static void periods(Machine m, const std::string& name, Steps& all) {
    supervise(m);
    const auto add = [&](const char* what, const auto& change) {
      Machine next = m;
      change(next);
      all.push_back({name + what, next});
    };
    add("", [](Machine& n) { n.is_moving = n.is_moving && is_on_path(n.state); });
    if (is_enabled(m.state)) {
      add(", its guard or lost periods raise an alarm", [](Machine& n) { raise(n); });
    }
    switch (m.state) {
      case State::kEnabling:
        if (m.is_on || m.is_dry_run)
          add(", drives are on", [](Machine& n) { drop_program(n), enter(n, State::kReady); });
        add(", drives took too long", [](Machine& n) { raise(n); });
        return;
      case State::kDisabling:
        add(", drives are off", [](Machine& n) { enter(n, State::kOff); });
        return;
      case State::kReady:
        if (m.waiting > 0)
          add(", a program is there", [](Machine& n) {
            take_piece(n);
            enter(n, State::kLoaded);
          });
        return;
      case State::kApproaching:
      case State::kRunning:
      case State::kStarving:
        return follow(m, name, all);
      case State::kStarved:
        if (m.may_go_on && (m.has_piece || m.waiting > 0)) {
          add(", it goes on by itself", [](Machine& n) {
            if (!n.has_piece) take_piece(n);
            enter(n, State::kRunning);
            n.is_granted = true;
          });
        }
        if (!m.has_piece && m.waiting > 0) add(", takes a block", take_piece);
        return;
      case State::kJogging:
        add(", the joint moves", [](Machine& n) { n.is_moving = true; });
        add(", nobody holds it any more", be_ready);
        return;
      case State::kHoming:
        add(", drives have their references or not", be_ready);
        add(", drives do not come back", [](Machine& n) { raise(n); });
        return;
      case State::kHolding:
      case State::kAborting:
      case State::kFaultStop:
        add(", at rest", arrive);
        if (m.state == State::kAborting) {
          add(", drives do not come back", [](Machine& n) { raise(n); });
        }
        if (m.has_piece) add(", passes a piece", [](Machine& n) { pass(n); });
        return;
      default:
        return;
    }
  }
  static void be_ready(Machine& m) {
    m.is_moving = false;
    if (m.has_piece || m.waiting > 0) drop_program(m);
    enter(m, State::kReady);
  }
  static void pass(Machine& m) {
    m.has_piece = false;
    if (m.waiting > 0) take_piece(m);
  }
  static void follow(const Machine& m, const std::string& name, Steps& all) {
    const auto add = [&](const char* what, const auto& change) {
      Machine next = m;
      change(next);
      all.push_back({name + what, next});
    };
    if (m.has_piece) {
      for (const State s : {State::kApproaching, State::kRunning, State::kStarving}) {
        add(", moves", [s](Machine& n) { n.is_moving = true, n.state = s; });
        add(", rests between blocks", [s](Machine& n) { n.is_moving = false, n.state = s; });
      }
      add(", comes to a stop of the program", [](Machine& n) {
        n.is_moving = false;
        enter(n, State::kHeld);
      });
      add(", comes to a block's end", [](Machine& n) {
        n.is_moving = false;
        enter(n, State::kStepping);
      });
      add(", comes to the program's end", [](Machine& n) {
        n.is_moving = n.has_piece = false;
        enter(n, State::kReady);
      });
    }
    if (m.waiting > 0) add(", goes to the next block", [](Machine& n) { pass(n); });
    if (m.waiting == 0)
      add(", nothing follows", [](Machine& n) {
        n.is_moving = n.has_piece = false;
        n.may_go_on = true;
        enter(n, State::kStarved);
      });
  }

  Table table_;
  bool voids_words_;
};

}  // namespace meridian::test
