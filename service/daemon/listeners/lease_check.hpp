// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace meridian::interpolator {

/// Which of the services that claim one machine keeps it, from what they say of themselves alone;
/// their clocks are never compared. All times are of one's own monotonic clock, ns.
///
/// For how long another one has served is heard late, never early, so the least lead that was heard
/// is the truest one. The one that has served longer keeps the machine; within kSame_ns, and where
/// words are too late to decide within kUnsure_ns, the smaller service_id does. Who gives way steps
/// back first: it says that it does not serve any more and leaves kStepBack_ns later, where another
/// one serves then still. Words that take less than that reach the other before it can leave too,
/// so one keeps the machine always.
///
/// The drives decide first: a service that they obey never leaves, whatever others claim, and gives
/// no way; one that hears that they obey another service, which serves, gives way to that one. What
/// nobody can have served (kLongest_ns) is not heard, and no more than kMaxOthers are kept.
/// Proof: tests/unit/daemon/lease_check_test.cpp.
class LeaseCheck {
 public:
  /// What a service says of itself.
  struct Word {
    std::uint64_t service_id = 0;
    bool is_serving = false;
    std::int64_t served_ns = 0;  ///< since hold()
  };

  static constexpr std::int64_t kPeriod_ns = 500'000'000;  ///< words while another one serves too
  static constexpr std::int64_t kSame_ns = 100'000'000;
  static constexpr std::int64_t kUnsure_ns = 3'000'000'000;
  static constexpr std::int64_t kPatience_ns = 4'000'000'000;  ///< for words that decide
  static constexpr std::int64_t kStepBack_ns = 1'500'000'000;
  static constexpr std::int64_t kLongest_ns = 315'360'000'000'000'000;  ///< 10 years
  static constexpr std::size_t kMaxOthers = 16;

  explicit LeaseCheck(std::uint64_t service_id) noexcept : service_id_(service_id) {}

  /// The machine is ours from now on.
  void hold(std::int64_t now_ns) noexcept;
  /// What another service says; `now_ns` is not before the word was taken. False: it is
  /// implausible, or one too many, and changes nothing.
  bool hear(const Word& word, std::int64_t now_ns);
  /// That service is not there any more.
  void forget(std::uint64_t service_id);
  /// Steps back or serves again. `now_ns` is not after words were last taken. A service that may
  /// not leave the machine, because that moves, does not step back. `master`: the service that the
  /// drives say that they obey, 0: not known.
  void check(std::int64_t now_ns, bool may_leave, std::uint64_t master = 0) noexcept;

  [[nodiscard]] Word word(std::int64_t now_ns) const noexcept;
  /// Whether others are to hear word() now.
  [[nodiscard]] bool has_to_speak(std::int64_t now_ns) const noexcept;
  /// `word` has been said, `now_ns` is not before that.
  void on_said(const Word& word, std::int64_t now_ns) noexcept;

  /// Whom the machine is to be left to, if anyone; `now_ns` as for check().
  [[nodiscard]] std::optional<std::uint64_t> keeper(std::int64_t now_ns) const noexcept;

 private:
  struct Other {
    std::uint64_t service_id = 0;
    bool is_serving = false;
    std::int64_t beside_since_ns = 0;                                 ///< it and we serve
    std::int64_t lead_ns = std::numeric_limits<std::int64_t>::max();  ///< by which we served longer
  };

  [[nodiscard]] bool yields_to(const Other& other, std::int64_t now_ns,
                               std::uint64_t master) const noexcept;

  std::uint64_t service_id_;
  std::optional<std::int64_t> held_ns_;
  bool has_stepped_back_ = false;
  std::optional<std::int64_t> back_since_ns_;  ///< others may know
  bool said_serving_ = false;
  std::int64_t said_ns_ = 0;
  std::vector<Other> others_;
};

}  // namespace meridian::interpolator
