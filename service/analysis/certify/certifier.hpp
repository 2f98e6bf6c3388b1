// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/analysis/certify/certificate.hpp"
#include "service/analysis/certify/join_check.hpp"
#include "service/analysis/certify/piece_check.hpp"

namespace meridian::certify {

/// Takes a plan piece by piece, as it is published, and proves that it keeps the machine's limits
/// between the instants that anybody looks at, too. Memory does not grow with the plan.
/// Context: a tool's thread. Proof: tests/unit/certify.
class Certifier {
 public:
  explicit Certifier(const MachineModel& model);

  /// The next piece in the order of publication, and its path where it moves (else nullptr).
  void add(const TimePiece& piece, const PathPiece* path);
  /// The plan is over: it rests where its last piece ends.
  void finish();

  [[nodiscard]] const Certificate& certificate() const noexcept { return certificate_; }

 private:
  void begin_window(const TimePiece& piece);
  void add_motion(const TimePiece& piece, const PathPiece& path);
  void note(const PieceVerdict& verdict);
  void note(const JoinCheck::Verdict& verdict);
  void find(CertificateFinding::Kind kind, const Share& share);

  const MachineModel& model_;
  PieceCheck pieces_;
  JoinCheck committed_;  ///< along the plan without tails
  JoinCheck tail_;       ///< along the tail of the window
  Certificate certificate_;
  LocatedShare location_;  ///< of the piece that is looked at
  std::uint16_t epoch_ = 0;
  bool has_begun_ = false, is_on_tail_ = false;
  std::uint64_t path_index_ = 0;
};

}  // namespace meridian::certify
