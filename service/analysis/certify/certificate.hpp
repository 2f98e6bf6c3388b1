// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/analysis/certify/piece_check.hpp"

namespace meridian::certify {

/// A share of a limit and the piece that it is of. `window` and `piece` count from 0, the latter in
/// its window.
struct LocatedShare {
  Share share;
  std::uint32_t window = 0, piece = 0, line = 0;
  std::uint64_t sequence = 0;
  bool is_tail = false;
};

/// Why the certificate is not given.
struct CertificateFinding {
  enum class Kind : std::uint8_t { kRefuted, kUndecided, kBrokenJoin };
  Kind kind = Kind::kRefuted;
  LocatedShare at;
};

/// What was proved of a plan. Units: s, shares of limits.
struct Certificate {
  static constexpr std::size_t kMaxFindings = 50;

  std::uint64_t pieces = 0;  ///< that move
  std::uint64_t refuted = 0, undecided = 0;
  std::uint64_t joins = 0, broken_joins = 0;
  std::uint64_t stretches = 0;                  ///< that were enclosed
  double plan_s = 0, tails_s = 0;               ///< of motion; of tails that bring windows to rest
  std::array<LocatedShare, kQuantities> bound;  ///< no share is larger anywhere
  std::array<LocatedShare, kQuantities> attained;  ///< so much is used somewhere
  std::array<LocatedShare, 3> jump;                ///< of joins, by order of the difference
  std::vector<CertificateFinding> findings;        ///< the first kMaxFindings
  double computing_s = 0;                          ///< of this host

  [[nodiscard]] bool is_given() const noexcept {
    return refuted == 0 && undecided == 0 && broken_joins == 0;
  }
};

/// The certificate for a person.
[[nodiscard]] std::string to_text(const Certificate& certificate, const MachineModel& model);

}  // namespace meridian::certify
