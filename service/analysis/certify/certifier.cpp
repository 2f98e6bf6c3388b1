// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/certifier.hpp"

#include <chrono>

namespace meridian::certify {

Certifier::Certifier(const MachineModel& model)
    : model_(model), pieces_(model), committed_(model), tail_(model) {}

void Certifier::find(CertificateFinding::Kind kind, const Share& share) {
  if (certificate_.findings.size() == Certificate::kMaxFindings) return;
  location_.share = share;
  certificate_.findings.push_back({kind, location_});
}

void Certifier::note(const PieceVerdict& verdict) {
  ++certificate_.pieces;
  certificate_.stretches += verdict.stretches;
  for (std::size_t n = 0; n < kQuantities; ++n) {
    location_.share = verdict.bound[n];
    if (!(location_.share.share <= certificate_.bound[n].share.share))
      certificate_.bound[n] = location_;
    location_.share = verdict.attained[n];
    if (location_.share.share > certificate_.attained[n].share.share) {
      certificate_.attained[n] = location_;
    }
  }
  if (verdict.status == Status::kRefuted) {
    ++certificate_.refuted;
    find(CertificateFinding::Kind::kRefuted, verdict.worst);
  } else if (verdict.status == Status::kUndecided) {
    ++certificate_.undecided;
    find(CertificateFinding::Kind::kUndecided, verdict.worst);
  }
}

void Certifier::note(const JoinCheck::Verdict& verdict) {
  ++certificate_.joins;
  for (std::size_t n = 0; n < verdict.worst.size(); ++n) {
    location_.share = verdict.worst[n];
    if (!(location_.share.share <= certificate_.jump[n].share.share))
      certificate_.jump[n] = location_;
  }
  if (verdict.is_joined) return;
  ++certificate_.broken_joins;
  find(CertificateFinding::Kind::kBrokenJoin, verdict.broken);
}

/// A window goes on where the one before is committed to, or from the rest that its tail ends at.
void Certifier::begin_window(const TimePiece& piece) {
  const bool is_other_epoch = !has_begun_ || piece.epoch != epoch_;
  if (has_begun_ && (is_on_tail_ || piece.is_from_rest || is_other_epoch)) {
    note((is_on_tail_ ? tail_ : committed_).rest());
  }
  if (is_other_epoch) {
    committed_.forget();
  } else if (is_on_tail_ && piece.is_from_rest) {
    committed_ = tail_;
  }
  has_begun_ = true;
  is_on_tail_ = false;
  epoch_ = piece.epoch;
  location_.window = piece.window;
  location_.piece = 0;
}

void Certifier::add(const TimePiece& piece, const PathPiece* path) {
  const auto begin = std::chrono::steady_clock::now();
  if (!has_begun_ || piece.epoch != epoch_ || piece.window != location_.window) {
    begin_window(piece);
  } else {
    ++location_.piece;
  }
  location_.line = piece.line;
  location_.sequence = piece.sequence;
  location_.is_tail = piece.is_tail;
  if (piece.is_tail && !is_on_tail_) {
    tail_ = committed_;
    is_on_tail_ = true;
  }
  if (piece.kind == TimeKind::kMove && path != nullptr) {
    add_motion(piece, *path);
  } else {
    note((is_on_tail_ ? tail_ : committed_).rest());
  }
  certificate_.computing_s +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void Certifier::add_motion(const TimePiece& piece, const PathPiece& path) {
  const PieceVerdict verdict = pieces_.check(piece, path);
  note(verdict);
  JoinCheck& joins = piece.is_tail ? tail_ : committed_;
  note(joins.go_on(verdict, piece.duration, path.index == path_index_));
  path_index_ = path.index;
  (piece.is_tail ? certificate_.tails_s : certificate_.plan_s) += piece.duration;
}

void Certifier::finish() {
  if (!has_begun_) return;
  note((is_on_tail_ ? tail_ : committed_).rest());
  has_begun_ = false;
}

}  // namespace meridian::certify
