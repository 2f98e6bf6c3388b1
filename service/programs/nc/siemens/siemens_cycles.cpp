// SPDX-License-Identifier: Apache-2.0
// Drilling cycles of Siemens: planes are Z of the program, lengths count from the reference plane.
#include "service/programs/nc/siemens/siemens_cycles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::HoleKind;
using cl::refuse;

constexpr double kSameDepth = 1e-6;

/// Places of arguments, from 0.
struct SiemensRow {
  std::string_view name;
  HoleKind kind = HoleKind::kDrill;
  int dwell = 0;
  int settings = 0;  ///< GMODE, DMODE, AMODE of newer controls
};

constexpr int kReturn = 0, kReference = 1, kClearance = 2, kDepth = 3, kRelativeDepth = 4;
/// Of CYCLE83.
constexpr int kFirstDepth = 5, kFirstRelative = 6, kDecrement = 7, kFirstFeedShare = 10,
              kVariant = 11, kMinPeck = 13, kBack = 14;
/// Of CYCLE85.
constexpr int kFeedIn = 6, kFeedOut = 7;

constexpr std::array kSiemensCycles =
    std::to_array<SiemensRow>({{"CYCLE81", HoleKind::kDrill, 5, 6},
                               {"CYCLE82", HoleKind::kDrill, 5, 6},
                               {"CYCLE83", HoleKind::kDeep, 8, 17},
                               {"CYCLE85", HoleKind::kFeedOut, 5, 8},
                               {"CYCLE89", HoleKind::kFeedOut, 5, 6}});

const SiemensRow* find_siemens_cycle(std::string_view name) {
  const auto at = std::find_if(kSiemensCycles.begin(), kSiemensCycles.end(),
                               [name](const SiemensRow& row) { return row.name == name; });
  return at == kSiemensCycles.end() ? nullptr : &*at;
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// The arguments by their place; what is left out is zero.
class Arguments {
 public:
  static Expected<Arguments, cl::Refusal> read(const State& s, const Line::Name& name) {
    Arguments out;
    std::string_view text = name.arguments;
    for (int k = 0; !text.empty(); ++k) {
      const std::size_t stop = std::min(text.find(','), text.size());
      const std::string_view one = without_blanks(text.substr(0, stop));
      text.remove_prefix(std::min(stop + 1, text.size()));
      double number = 0;
      const auto variable = s.variables.find(one);
      const bool is_number = one.empty() || variable || cl::parse_number(one, number);
      if (!is_number || k >= static_cast<int>(out.numbers_.size())) {
        return refuse(std::string(name.name) + ": argument " + std::to_string(k + 1) +
                          (is_number ? " is one too many" : " is no number"),
                      kMovesByCam, std::string(name.name));
      }
      out.numbers_[static_cast<std::size_t>(k)] = variable.value_or(number);
    }
    return out;
  }
  [[nodiscard]] double operator[](int k) const {
    return k < 0 ? 0 : numbers_[static_cast<std::size_t>(k)];
  }

 private:
  std::array<double, 24> numbers_{};
};

/// A depth below the reference plane, given as Z, as a length, or as both.
Expected<double, cl::Refusal> depth_of(const Arguments& v, int absolute, int relative,
                                       std::string_view name) {
  const double by_plane = v[kReference] - v[absolute];
  if (v[relative] == 0) return by_plane;
  const double depth = std::abs(v[relative]);
  const bool is_reported_twice = v[absolute] != 0 && std::abs(by_plane - depth) > kSameDepth;
  if (is_reported_twice) {
    return refuse(std::string(name) + ": two depths, " + cl::short_number(by_plane) +
                      " by its Z and " + cl::short_number(depth) + " as a length",
                  "give one of them", std::string(name));
  }
  return depth;
}

/// Each peck is shorter than the one before by the decrement, down to it; the last two share what
/// is left. A decrement below zero is the share that is left of the peck before.
Expected<std::vector<double>, cl::Refusal> pecks_of(const Arguments& v, double depth) {
  constexpr std::size_t kMaxPecks = 10000;
  auto first = depth_of(v, kFirstDepth, kFirstRelative, "CYCLE83");
  if (!first) return tl::make_unexpected(first.error());
  if (v[kFirstDepth] == 0 && v[kFirstRelative] == 0) *first = depth;
  const double decrement = v[kDecrement];
  const double min = decrement < 0 ? std::max(v[kMinPeck], depth * 1e-3) : decrement;
  std::vector<double> pecks;
  double peck = std::min(*first, depth), left = depth;
  if (!(peck > 0)) return refuse("CYCLE83: its first depth is not below the reference plane");
  while (left > 1e-9 * depth && pecks.size() < kMaxPecks) {
    const bool is_shared = decrement > 0 && !pecks.empty() && left > peck && left < 2 * peck;
    if (is_shared) peck = left / 2;
    pecks.push_back(std::min(peck, left));
    left -= pecks.back();
    if (is_shared) continue;
    if (decrement > 0 && peck - decrement > 0) peck = std::max(peck - decrement, min);
    if (decrement < 0) peck = std::max(-decrement * peck, min);
  }
  return pecks;
}

/// GMODE, DMODE and AMODE of newer controls: the tip's depth in the plane XY, nothing else.
cl::Outcome check_settings(const Arguments& v, const SiemensRow& row) {
  const double plane = std::fmod(v[row.settings + 1], 10);
  if (v[row.settings] != 0 || plane > 1) {
    return refuse(std::string(row.name) + " whose depth is not that of the tip, or outside G17",
                  kMovesByCam, std::string(row.name));
  }
  return {};
}

cl::Outcome add_pecks(const State& s, const Arguments& v, cl::HoleCycle& hole) {
  if (v[kFirstFeedShare] != 0 && v[kFirstFeedShare] != 1) {
    return refuse("CYCLE83 with another feed for its first peck (FRF)", "write 1", "FRF");
  }
  auto pecks = pecks_of(v, hole.depth);
  if (!pecks) return tl::make_unexpected(pecks.error());
  hole.pecks = std::move(*pecks);
  if (v[kVariant] == 0) {
    hole.kind = HoleKind::kChipBreak;
    const double one_mm = 1 / s.cl.units.to_mm;
    hole.back = v[kBack] > 0 ? v[kBack] : one_mm;
  }
  return {};
}

}  // namespace

bool is_siemens_drilling(std::string_view name) { return find_siemens_cycle(name) != nullptr; }

Expected<Drilling, cl::Refusal> siemens_drilling(const State& s, const Line::Name& name) {
  const SiemensRow& row = *find_siemens_cycle(name.name);
  const auto v = Arguments::read(s, name);
  if (!v) return tl::make_unexpected(v.error());
  if (auto done = check_settings(*v, row); !done) return tl::make_unexpected(done.error());
  const auto depth = depth_of(*v, kDepth, kRelativeDepth, row.name);
  if (!depth) return tl::make_unexpected(depth.error());
  Drilling out;
  out.top = (*v)[kReference];
  cl::HoleCycle& hole = out.hole;
  hole.kind = row.kind;
  hole.depth = *depth;
  hole.rapid_level = std::abs((*v)[kClearance]);
  hole.retract_level = (*v)[kReturn] - (*v)[kReference];
  if (!(hole.depth > 0) || hole.retract_level < 0) {
    return refuse(std::string(row.name) +
                      ": the depth has to be below the reference plane, the retract plane above it",
                  {}, std::string(row.name));
  }
  const double dwell = (*v)[row.dwell];
  const bool counts_turns = dwell < 0 || std::fmod((*v)[row.settings + 2], 100) >= 20;
  (counts_turns ? hole.dwell_revolutions : hole.dwell_s) = std::abs(dwell);
  if (row.name == "CYCLE83") {
    if (auto done = add_pecks(s, *v, hole); !done) return tl::make_unexpected(done.error());
  }
  if (row.name == "CYCLE85") {
    if ((*v)[kFeedIn] > 0) hole.feed = {(*v)[kFeedIn], cl::FeedUnit::kPerMinute};
    if ((*v)[kFeedOut] > 0) hole.feed_out = {(*v)[kFeedOut], cl::FeedUnit::kPerMinute};
  }
  return out;
}

}  // namespace meridian::nc
