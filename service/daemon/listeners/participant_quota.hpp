// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace meridian::interpolator {

/// How much each participant may ask for: so many requests at once, and so many a second from then
/// on. One that sends more is heard no more than that; others are not held back. Stops are obeyed
/// before anybody asks this; beyond it they are only not answered. Of more participants than there
/// are places the one that was silent for longest is forgotten. Time is an argument; one thread.
/// Proof: tests/unit/daemon/participant_quota_test.cpp.
class ParticipantQuota {
 public:
  constexpr ParticipantQuota(double per_second, double at_once) noexcept
      : per_second_(per_second), at_once_(at_once) {
    nobody_.left = at_once;
  }

  enum class Result : std::uint8_t {
    kAllowed,
    kFirstBeyond,  ///< the first that is too many since one was allowed: to be reported
    kBeyond
  };

  [[nodiscard]] Result take(std::uint64_t participant, std::int64_t now_ns) noexcept {
    Account& account = account_of(participant, now_ns);
    const double elapsed_s = 1e-9 * static_cast<double>(now_ns - account.newest_ns);
    account.left = std::min(at_once_, account.left + per_second_ * elapsed_s);
    account.newest_ns = now_ns;
    if (account.left >= 1) {
      account.left -= 1;
      // One report a flood, not one for each request that fits between those that do not.
      if (account.left >= at_once_ / 2) account.is_reported = false;
      return Result::kAllowed;
    }
    if (account.is_reported) return Result::kBeyond;
    account.is_reported = true;
    return Result::kFirstBeyond;
  }

 private:
  struct Account {
    std::uint64_t participant = 0;
    std::int64_t newest_ns = 0;
    double left = 0;
    bool is_reported = false;
  };

  [[nodiscard]] Account& account_of(std::uint64_t participant, std::int64_t now_ns) noexcept {
    const auto known = std::find_if(
        accounts_.begin(), accounts_.end(),
        [participant](const Account& account) { return account.participant == participant; });
    if (known != accounts_.end() && participant != 0) return *known;
    if (participant == 0) return nobody_;
    Account& oldest = *std::min_element(
        accounts_.begin(), accounts_.end(),
        [](const Account& a, const Account& b) { return a.newest_ns < b.newest_ns; });
    oldest = {participant, now_ns, at_once_, false};
    return oldest;
  }

  double per_second_, at_once_;
  std::array<Account, 64> accounts_{};
  Account nobody_{};  ///< all whose participant is not known any more
};

}  // namespace meridian::interpolator
