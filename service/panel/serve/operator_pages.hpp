// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "meridian/cycle/state.hpp"
#include "service/panel/desks/operator_desk.hpp"
#include "service/panel/jog_grip.hpp"
#include "service/panel/serve/page_message.hpp"
#include "service/panel/serve/server.hpp"

namespace meridian::panel {

/// Who of the open pages operates the machine, and what becomes of what pages ask for. One page at
/// a time is the operator's: the first that asks for anything but a stop, until it is closed or
/// another one takes over. Every page may stop the machine. Any thread.
/// Proof: tests/panel/operating_test.cpp.
class OperatorPages {
 public:
  /// Why a page is refused that is not the operator's.
  static constexpr const char* kOtherOperates =
      "another page operates this machine: take over first, if that is meant";

  /// Where commands and jogs go; of OperatorDesk, or of a test.
  struct Desk {
    std::function<void(Verb, double, const stream::Seen&, OnOutcome)> ask;
    std::function<void(const stream::JogPlan&, std::shared_ptr<JogGrip>, OnOutcome)> jog;
    std::function<std::uint64_t()> newest_status;  ///< status_sequence; 0: the machine is silent
    /// What moves nothing and quotes nothing: kCheck, kLoad, kUnload, kAnswer.
    std::function<Outcome(const PageMessage&)> serve;
  };

  explicit OperatorPages(Desk desk) : desk_(std::move(desk)) {}

  void open(PageLink& page);
  void read(PageLink& page, std::string_view text);
  void close(PageLink& page);

  /// Whether the page that was given this key is the operator's, or becomes so now: requests beside
  /// the page's link bring it.
  [[nodiscard]] bool may_operate(std::string_view key);

 private:
  struct Page {
    PageLink* link;
    std::string key;
  };

  /// Whether the page is the operator's; it becomes so where none is.
  [[nodiscard]] bool may_operate(std::uint64_t page);
  void handle(std::uint64_t page, const PageMessage& message);
  void ask(std::uint64_t page, const PageMessage& message);
  void jog(std::uint64_t page, const PageMessage& message);
  void serve(std::uint64_t page, const PageMessage& message);
  /// Whether a page that saw this sees the machine as it is.
  [[nodiscard]] bool sees_now(const stream::Seen& seen) const;
  void take_over(std::uint64_t page);
  void say(std::uint64_t page, const std::string& text);
  void say_who_operates();
  void answer(std::uint64_t page, std::uint64_t id, const Outcome& outcome);

  Desk desk_;
  std::mutex mutex_;
  std::map<std::uint64_t, Page> pages_;
  std::uint64_t count_ = 0;
  std::uint64_t operator_ = 0;  ///< page that operates; 0: none
  std::shared_ptr<JogGrip> grip_;
};

}  // namespace meridian::panel
