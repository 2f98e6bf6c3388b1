// SPDX-License-Identifier: Apache-2.0
// The modes that the reader keeps from statement to statement, walked through every change.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "service/programs/cl/dialect.hpp"
#include "service/programs/cl/interpreter/frame_chain.hpp"

namespace meridian::cl {
namespace {

struct Show {
  std::vector<Dialect> before;  ///< what the file has shown
  std::optional<Dialect> caller;
  Dialect shown;
  bool is_alike;
  Dialect dialect;
  MissingAxis missing_axis;
};

constexpr Dialect kNothing = Dialect::kUnknown, kNx = Dialect::kNx, kCreo = Dialect::kCreo;

TEST(Modes, OfTheDialectFollowWhatIsShown) {
  const std::vector<Show> walk = {
      {{}, {}, kNothing, true, kNothing, MissingAxis::kAsk},
      {{}, {}, kNx, true, kNx, MissingAxis::kStays},
      {{}, {}, kCreo, true, kCreo, MissingAxis::kPlusZ},
      {{kNx}, {}, kNothing, true, kNx, MissingAxis::kStays},
      {{kNx}, {}, kNx, true, kNx, MissingAxis::kStays},
      {{kNx}, {}, kCreo, false, kNx, MissingAxis::kAsk},
      {{kNx, kCreo}, {}, kNothing, true, kNx, MissingAxis::kAsk},
      {{kNx, kCreo}, {}, kNx, true, kNx, MissingAxis::kAsk},
      {{kNx, kCreo}, {}, kCreo, false, kNx, MissingAxis::kAsk},
      {{}, kNx, kNothing, true, kNx, MissingAxis::kStays},
      {{}, kNx, kNx, true, kNx, MissingAxis::kStays},
      {{}, kNx, kCreo, true, kNx, MissingAxis::kStays},
  };
  for (std::size_t row = 0; row < walk.size(); ++row) {
    const Show& show = walk[row];
    DialectFinder finder(show.caller);
    for (const Dialect dialect : show.before) (void)finder.see(dialect, 1, "a word");
    EXPECT_EQ(finder.see(show.shown, 2, "another"), show.is_alike) << "row " << row;
    EXPECT_EQ(finder.dialect(), show.dialect) << "row " << row;
    EXPECT_EQ(finder.missing_axis(), show.missing_axis) << "row " << row;
    EXPECT_EQ(finder.is_reported(), show.caller.has_value()) << "row " << row;
  }
}

/// 'w': a word of the file moves the frame, 'c': COPY does, 'r': a motion resolves it. Whether each
/// motion is news: "n", or not: "-".
std::string news_of(std::string_view changes) {
  FrameChain frames({});
  std::string news;
  double x = 0;
  for (const char change : changes) {
    x += 1;
    const Frame moved{Eigen::Matrix3d::Identity(), {x, 0, 0}};
    if (change == 'w') frames.set_shift(moved);
    if (change == 'c') frames.set_copy(moved);
    if (change == 'r') news += frames.resolve(1) ? "n" : "-";
    EXPECT_EQ(frames.is_resolved(), change == 'r') << changes;
  }
  return news;
}

TEST(Modes, OfTheFramesKnowWhatChangedSinceTheLastMotion) {
  EXPECT_EQ(news_of("r"), "-");
  EXPECT_EQ(news_of("wr"), "-") << "the first frame is the reference";
  EXPECT_EQ(news_of("rr"), "--");
  EXPECT_EQ(news_of("rwr"), "-n");
  EXPECT_EQ(news_of("rwwr"), "-n");
  EXPECT_EQ(news_of("rcr"), "--");
  EXPECT_EQ(news_of("rccr"), "--");
  EXPECT_EQ(news_of("rwcr"), "--");
  EXPECT_EQ(news_of("rcwr"), "--");
  EXPECT_EQ(news_of("rcrwr"), "--n") << "COPY is forgotten with the motion after it";
}

}  // namespace
}  // namespace meridian::cl
