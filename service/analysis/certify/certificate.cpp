// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/certificate.hpp"

#include <algorithm>

#include "meridian/kinematics/limited.hpp"
#include "service/text/printed.hpp"

namespace meridian::certify {
namespace {

using text::append;
using text::Count;

constexpr std::array<const char*, kQuantities> kNames{"velocity", "acceleration", "jerk", "feed"};
constexpr std::array<const char*, 3> kKinds{"REFUTED", "UNDECIDED", "NOT JOINED"};

[[nodiscard]] std::string name_of(const Share& share, const MachineModel& model) {
  return share.joint < 0 ? "tip" : limited_spec(model, share.joint).name;
}

void append_location(std::string& out, const LocatedShare& at) {
  append(out, "line %u, block %llu, piece %u of window %u%s, %.6f s into it\n", at.line,
         static_cast<Count>(at.sequence), at.piece, at.window, at.is_tail ? ", its tail" : "",
         at.share.time_s);
}

}  // namespace

std::string to_text(const Certificate& c, const MachineModel& model) {
  if (c.pieces == 0) return "no certificate: no motion was planned\n";
  std::string out;
  append(out,
         "certificate %s: %llu of %llu pieces certified, %llu refuted, %llu undecided; %llu joins, "
         "%llu broken\n",
         c.is_given() ? "given" : "NOT given",
         static_cast<Count>(c.pieces - c.refuted - c.undecided), static_cast<Count>(c.pieces),
         static_cast<Count>(c.refuted), static_cast<Count>(c.undecided),
         static_cast<Count>(c.joins), static_cast<Count>(c.broken_joins));
  append(out, "  of %.3f s of motion and %.3f s of tails, %llu stretches, in %.2f s\n", c.plan_s,
         c.tails_s, static_cast<Count>(c.stretches), c.computing_s);
  for (std::size_t n = 0; n < kQuantities; ++n) {
    const LocatedShare& bound = c.bound[n];
    append(out, "  %-12s at most %.6f of the limit, %.6f used: %s, line %u\n", kNames[n],
           bound.share.share, c.attained[n].share.share, name_of(bound.share, model).c_str(),
           bound.line);
  }
  append(out, "  jumps at joins add at most %.1e, %.1e, %.1e of velocity, acceleration, jerk\n",
         c.jump[0].share.share, c.jump[1].share.share, c.jump[2].share.share);
  for (const CertificateFinding& finding : c.findings) {
    const Share& share = finding.at.share;
    append(out, "  %s: %s of %s %.9g of the limit, ",
           kKinds[static_cast<std::size_t>(finding.kind)],
           kNames[static_cast<std::size_t>(share.quantity)], name_of(share, model).c_str(),
           share.share);
    append_location(out, finding.at);
  }
  return out;
}

}  // namespace meridian::certify
