// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/certifier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/machines.hpp"
#include "support/simulated_run.hpp"

namespace meridian::certify {
namespace {

/// Lines, a corner, a tilt, an arc and a rapid.
constexpr const char* kPart =
    "UNITS / MM\nMULTAX / ON\nFEDRAT / 2400, MMPM\n"
    "GOTO / 80, -40, 20, 0.2, 0, 0.979796\nGOTO / 85, -40, 20, 0.2, 0, 0.979796\n"
    "GOTO / 85, -36, 18, 0.1, 0.2, 0.974679\nGOTO / 80, -36, 18, 0, 0.2, 0.979796\n"
    "CIRCLE / 78, -36, 18, 0, 0, 1, 2\nGOTO / 76, -36, 18, 0, 0.2, 0.979796\n"
    "RAPID\nGOTO / 76, -36, 40, 0, 0, 1\nFINI\n";

[[nodiscard]] Certificate certify(const MachineModel& model, Transition transition) {
  Certifier certifier(model);
  simulate::SimulateOptions options;
  options.settings.transition = transition;
  options.certifier = &certifier;
  const test::SimulatedRun run = test::run_simulation(kPart, model, options);
  EXPECT_EQ(run.report.outcome, simulate::Outcome::kDone) << run.report.reason;
  return certifier.certificate();
}

TEST(Certifier, GivesACertificateForAWholeProgramInBothTransitions) {
  const MachineModel model = test::lai_machine();
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const Certificate given = certify(model, transition);
    EXPECT_TRUE(given.is_given()) << to_text(given, model);
    EXPECT_GT(given.pieces, 30U);
    EXPECT_EQ(given.tails_s > 0, transition == Transition::kSmooth);
    for (const LocatedShare& bound : given.bound) {
      EXPECT_LE(bound.share.share, 1);
      EXPECT_GT(bound.share.share, 0.3);
    }
    for (std::size_t n = 0; n < kQuantities; ++n) {
      EXPECT_LE(given.attained[n].share.share, given.bound[n].share.share);
    }
    EXPECT_NE(to_text(given, model).find("certificate given"), std::string::npos);
  }
}

/// Two lines of 10 mm at 50 mm/s, one after the other.
struct TwoLines {
  std::vector<PathPiece> paths = std::vector<PathPiece>(2);
  std::vector<TimePiece> times = std::vector<TimePiece>(2);

  explicit TwoLines(const MachineModel& model) {
    for (std::size_t n = 0; n < 2; ++n) {
      PathPiece& path = paths[n];
      path.index = n;
      path.length = 10;
      path.tip_begin = {10 + 10 * static_cast<double>(n), 20, 5};
      path.tip_delta = {10, 0, 0};
      path.axis_begin = {0.6, 0, 0.8};
      path.tool_length_mm = model.tool_length_mm;
      times[n].path_index = n;
      times[n].line = 7 + static_cast<std::uint32_t>(n);
      times[n].duration = 0.2;
      times[n].v = 50;
    }
    times[1].is_tail = true;
  }

  [[nodiscard]] Certificate certify(const MachineModel& model) const {
    Certifier certifier(model);
    for (std::size_t n = 0; n < 2; ++n) certifier.add(times[n], &paths[n]);
    return certifier.certificate();
  }
};

TEST(Certifier, FindsAPieceThatDoesNotJoinTheOneBefore) {
  const MachineModel model = test::lai_machine();
  EXPECT_TRUE(TwoLines(model).certify(model).is_given());
  TwoLines broken(model);
  broken.paths[1].tip_begin[0] += 1e-4;
  const Certificate refused = broken.certify(model);
  EXPECT_EQ(refused.broken_joins, 1U);
  ASSERT_EQ(refused.findings.size(), 1U);
  EXPECT_EQ(refused.findings[0].kind, CertificateFinding::Kind::kBrokenJoin);
  EXPECT_EQ(refused.findings[0].at.line, 8U);
  EXPECT_NE(to_text(refused, model).find("NOT JOINED: jerk"), std::string::npos);
}

TEST(Certifier, FindsAPlanThatDoesNotRestWhereItEnds) {
  const MachineModel model = test::lai_machine();
  Certifier certifier(model);
  EXPECT_NE(to_text(certifier.certificate(), model).find("no certificate"), std::string::npos);
  const TwoLines lines(model);
  certifier.add(lines.times[0], lines.paths.data());
  EXPECT_TRUE(certifier.certificate().is_given());
  certifier.finish();
  EXPECT_EQ(certifier.certificate().broken_joins, 1U);
}

TEST(Certifier, NamesThePieceThatIsOverALimit) {
  MachineModel model = test::lai_machine();
  const TwoLines lines(model);
  model.joints[0].limits.velocity = 49;
  const Certificate refused = lines.certify(model);
  EXPECT_EQ(refused.refuted, 2U);
  EXPECT_EQ(refused.findings.front().at.line, 7U);
  EXPECT_NEAR(refused.findings.front().at.share.share, 50.0 / 49, 1e-9);
  EXPECT_NE(to_text(refused, model).find("REFUTED: velocity of b3 1.02040816"), std::string::npos);
}

TEST(Certifier, GoesOnWhereAWindowIsCommittedToAndNotWhereItsTailEnds) {
  const MachineModel model = test::lai_machine();
  TwoLines lines(model);
  Certifier certifier(model);
  for (std::size_t n = 0; n < 2; ++n) certifier.add(lines.times[n], &lines.paths[n]);
  TimePiece next = lines.times[1];  // the same line again, now of the next window
  next.is_tail = false;
  next.window = 1;
  certifier.add(next, &lines.paths[1]);
  EXPECT_EQ(certifier.certificate().broken_joins, 1U);  // the tail, which does not rest
  next.window = 2;
  certifier.add(next, &lines.paths[1]);
  EXPECT_EQ(certifier.certificate().broken_joins, 2U);
}

}  // namespace
}  // namespace meridian::certify
