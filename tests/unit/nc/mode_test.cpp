// SPDX-License-Identifier: Apache-2.0
// The modes that an NC program keeps from line to line, walked through every change.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "service/programs/nc/heidenhain/heidenhain_cycles.hpp"
#include "service/programs/nc/modes.hpp"
#include "service/programs/nc/siemens/siemens_line.hpp"
#include "service/programs/nc/siemens/siemens_names.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

using Transformation = Orientation::Transformation;
using Between = Orientation::Between;
using Axes = Orientation::Axes;

void expect_equal(const Orientation& got, const Orientation& want, const std::string& word) {
  EXPECT_EQ(got.transformation, want.transformation) << word;
  EXPECT_EQ(got.between, want.between) << word;
  EXPECT_EQ(got.axes, want.axes) << word;
}

TEST(Modes, OfTheOrientationAreThreeAndEachWordChangesOne) {
  struct Change {
    const char* word;
    std::function<void(Orientation&)> set;
  };
  const std::vector<Change> changes = {
      {"TRAORI", [](Orientation& o) { o.transformation = Transformation::kOn; }},
      {"TRAFOOF", [](Orientation& o) { o.transformation = Transformation::kOff; }},
      {"ORIAXES", [](Orientation& o) { o.between = Between::kEvenJoints; }},
      {"ORIVECT", [](Orientation& o) { o.between = Between::kGreatCircle; }},
      {"ORIWKS", [](Orientation& o) { o.axes = Axes::kOfPart; }},
      {"ORIMKS", [](Orientation& o) { o.axes = Axes::kOfMachine; }}};
  for (const Transformation transformation : {Transformation::kOff, Transformation::kOn}) {
    for (const Between between : {Between::kEvenJoints, Between::kGreatCircle}) {
      for (const Axes axes : {Axes::kOfPart, Axes::kOfMachine}) {
        for (const Change& change : changes) {
          State s(siemens(), nullptr, {});
          s.modes.orientation = {transformation, between, axes};
          Orientation want = s.modes.orientation;
          change.set(want);
          Line line;
          ASSERT_TRUE(cut_siemens(change.word, 1, line, s.variables)) << change.word;
          ASSERT_TRUE(take_names(s, line)) << change.word;
          expect_equal(s.modes.orientation, want, change.word);
        }
      }
    }
  }
}

enum class Called : std::uint8_t { kNone, kCycle, kRefused };

Called called(const State& s) { return static_cast<Called>(s.modes.definition.index()); }

/// A program whose last CYCL DEF was such a one.
void define(State& s, Called last) {
  const Line line;
  if (last == Called::kCycle) {
    ASSERT_TRUE(define_cycle(s, line, "200", ""));
  }
  if (last == Called::kRefused) {
    ASSERT_FALSE(define_cycle(s, line, "262", ""));
  }
  s.modes.open = OpenDefinition::kNone;
  ASSERT_EQ(called(s), last);
}

constexpr std::array kCalled = {Called::kNone, Called::kCycle, Called::kRefused};

TEST(Modes, OfTheCalledCycleFollowEveryDefinition) {
  for (const Called before : kCalled) {
    State cycle(klartext(), nullptr, {}), refused(klartext(), nullptr, {}),
        preset(klartext(), nullptr, {});
    for (State* const s : {&cycle, &refused, &preset}) define(*s, before);
    const Line line;
    EXPECT_TRUE(define_cycle(cycle, line, "200", " DRILLING Q201=-9"));
    EXPECT_EQ(called(cycle), Called::kCycle);
    EXPECT_EQ(cycle.modes.open, OpenDefinition::kCycle);
    EXPECT_EQ(std::get<CycleDefinition>(cycle.modes.definition).parameters.at(201), -9);
    EXPECT_FALSE(define_cycle(refused, line, "262", " THREAD MILLING Q201=-9"));
    EXPECT_EQ(called(refused), Called::kRefused);
    EXPECT_EQ(refused.modes.open, OpenDefinition::kCycle);
    EXPECT_TRUE(define_cycle(preset, line, "247", " DATUM SETTING Q339=+1"));
    EXPECT_EQ(called(preset), before) << "a preset is no cycle that is called";
    EXPECT_EQ(preset.modes.open, OpenDefinition::kPreset);
  }
}

TEST(Modes, OfTheOpenDefinitionSayWhatItsParametersBelongTo) {
  for (const Called last : kCalled) {
    for (const auto open :
         {OpenDefinition::kNone, OpenDefinition::kCycle, OpenDefinition::kPreset}) {
      if (last == Called::kNone && open == OpenDefinition::kCycle) continue;  // CYCL DEF opens both
      State s(klartext(), nullptr, {});
      define(s, last);
      s.modes.open = open;
      const Line line;
      const bool is_taken = take_cycle_parameters(s, line, "Q339=+7").has_value();
      EXPECT_EQ(is_taken, open != OpenDefinition::kNone);
      EXPECT_EQ(called(s), last);
      if (last != Called::kCycle) continue;
      const auto& parameters = std::get<CycleDefinition>(s.modes.definition).parameters;
      EXPECT_EQ(parameters.contains(339), open == OpenDefinition::kCycle);
    }
  }
}

TEST(Modes, OfTheCalledCycleSayWhatACallDoes) {
  for (const Called last : kCalled) {
    State s(klartext(), nullptr, {});
    define(s, last);
    const auto done = call_cycle(s, Line{});
    EXPECT_EQ(done.has_value(), last == Called::kRefused) << "it was refused where it is defined";
    if (last != Called::kNone) continue;
    EXPECT_NE(done.error().message.find("no CYCL DEF"), std::string::npos);
  }
}

}  // namespace
}  // namespace meridian::nc
