// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/block.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/siemens/siemens_names.hpp"
#include "service/programs/nc/words/codes.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr std::string_view kLetters = "GMXYZABCUVWIJKRFSTHDPQLEO";

/// What the G codes of a block say that holds for this block alone.
struct OneShot {
  enum class Kind : std::uint8_t {
    kMove,
    kDwell,
    kHome,
    kReference,
    kMachinePosition,
    kPlaneTilt,
    kPlaneFollow,
    kLocalZero,
    kSetting,
    kNothing  ///< what its words say was done already
  };
  Kind kind = Kind::kMove;
};

std::string code_of(const Word& word) { return "G" + std::string(word.digits); }

cl::Outcome check_addresses(const Line& line) {
  for (const Word& word : line.words) {
    if (word.address.size() == 1 && kLetters.find(word.address.front()) == std::string_view::npos) {
      return refuse("address " + std::string(word.address) + " is not understood");
    }
  }
  return {};
}

/// Codes that were let through by name go to the machine.
cl::Outcome take_unknown(State& s, const Line& line, const Word& word) {
  const auto& allowed = s.cl.options.allowed_words;
  const std::string code = code_of(word);
  if (std::find(allowed.begin(), allowed.end(), code) != allowed.end()) {
    s.cl.path.vendor_word(code, word.number, line.number);
    return {};
  }
  return refuse(code + " is not known here",
                "--allow-unknown " + code + " passes it to the machine as a vendor word",
                "unknown " + code);
}

/// What a code of the kind says for its block alone; nothing: it is modal, or says nothing.
std::optional<OneShot::Kind> one_shot_of(GKind kind) {
  switch (kind) {
    case GKind::kDwell:
      return OneShot::Kind::kDwell;
    case GKind::kHome:
      return OneShot::Kind::kHome;
    case GKind::kReference:
      return OneShot::Kind::kReference;
    case GKind::kMachinePosition:
      return OneShot::Kind::kMachinePosition;
    case GKind::kPlaneTilt:
      return OneShot::Kind::kPlaneTilt;
    case GKind::kPlaneFollow:
      return OneShot::Kind::kPlaneFollow;
    case GKind::kLocalZero:
      return OneShot::Kind::kLocalZero;
    case GKind::kSetting:
      return OneShot::Kind::kSetting;
    case GKind::kAxesSetting:
      return OneShot::Kind::kNothing;
    default:
      return std::nullopt;
  }
}

cl::Outcome take_code(State& s, const Line& line, const GRow& row, OneShot& shot) {
  if (const auto kind = one_shot_of(row.kind)) {
    shot.kind = *kind;
    return {};
  }
  switch (row.kind) {
    case GKind::kMotion:
      s.modes.motion = static_cast<Motion>(row.value);
      begin_cycle(s, 0);
      break;
    case GKind::kCycle:
      begin_cycle(s, row.value);
      break;
    case GKind::kReturn:
      s.modes.cycle.returns_to_r = row.value != 0;
      break;
    case GKind::kPlane:
      s.modes.plane = row.value;
      break;
    case GKind::kUnit:
      return set_unit(s, row.value != 0 ? cl::LengthUnit::kInch : cl::LengthUnit::kMillimetre);
    case GKind::kDistance:
      s.modes.distance = row.value != 0 ? Distance::kIncremental : Distance::kAbsolute;
      break;
    case GKind::kCentre:
      s.modes.centre = row.value != 0 ? Distance::kAbsolute : Distance::kIncremental;
      break;
    case GKind::kFeed:
      if (s.modes.feed_unit != static_cast<cl::FeedUnit>(row.value)) s.cl.written_feed = {};
      s.modes.feed_unit = static_cast<cl::FeedUnit>(row.value);
      s.cl.feed.reset();
      break;
    case GKind::kControl:
      return take_length(s, line, static_cast<Control>(row.value));
    case GKind::kWorkOffset:
      return set_work_offset(s, line, row.tenths);
    case GKind::kPlaneOff:
      s.frames.parts = {};
      if (s.frames.tilt == Tilt::kNone || s.modes.has_dynamic_offset) {
        s.cl.summary.skip("G69", line.number);
        break;
      }
      set_plane(s, line, {}, Tilt::kNone);
      break;
    case GKind::kDynamicOffset:
      if (row.value != 0) return begin_dynamic_offset(s, line);
      end_dynamic_offset(s, line);
      break;
    default:
      break;
  }
  return {};
}

/// Whether the code says what holds anyway, or how the control smooths.
bool is_skipped(GKind kind) {
  return kind == GKind::kNothing || kind == GKind::kSetting || kind == GKind::kAxesSetting;
}

/// Two of one kind contradict each other, but for those that say nothing.
cl::Outcome check_kinds(const GRow& row, std::optional<GKind>& motion_kind,
                        std::array<bool, 32>& seen) {
  if (is_skipped(row.kind)) return {};
  bool& is_seen = seen[static_cast<std::size_t>(row.kind)];
  if (is_seen) return refuse("two G codes of one group in a block", "write one block for each");
  is_seen = true;
  const bool is_shot = row.kind == GKind::kDwell || row.kind == GKind::kHome ||
                       row.kind == GKind::kReference || row.kind == GKind::kPlaneTilt ||
                       row.kind == GKind::kPlaneFollow || row.kind == GKind::kLocalZero;
  if (is_shot && motion_kind)
    return refuse("two G codes of one group in a block", "write one block for each");
  if (is_shot || row.kind == GKind::kMachinePosition) motion_kind = row.kind;
  return {};
}

/// G54.2 P0 and G54.4 P0 of Fanuc end what is refused otherwise.
bool ends_offset(const GRow& row, const Line& line) {
  const Word* const p = line.find("P");
  return (row.tenths == 542 || row.tenths == 544) && p != nullptr && p->number == 0;
}

/// G15 ends polar coordinates; with H it is a work offset of Okuma controls.
cl::Outcome check_foreign_offset(const GRow& row, const Line& line) {
  if (row.tenths != 150 || line.find("H") == nullptr) return {};
  return refuse("G15 H" + std::string(line.find("H")->digits) + ": a work offset of Okuma controls",
                "output words of Fanuc", "G15 H");
}

cl::Outcome take_codes(State& s, const Line& line, OneShot& shot) {
  std::optional<GKind> motion_kind;
  std::array<bool, 32> seen{};
  const bool is_siemens = s.modes.language == Language::kSiemens;
  for (const Word& word : line.words) {
    if (!word.is('G')) continue;
    const GRow* const row = is_siemens ? find_siemens_g(word.number) : find_g(word.number);
    if (row == nullptr) {
      if (auto done = take_unknown(s, line, word); !done) return done;
      continue;
    }
    if (auto done = check_foreign_offset(*row, line); !done) return done;
    if (!is_siemens && ends_offset(*row, line)) {
      s.cl.summary.skip(code_of(word) + " P0", line.number);
      continue;
    }
    if (row->kind == GKind::kRefused) {
      return refuse(code_of(word) + ": " + std::string(row->note), std::string(row->remedy),
                    code_of(word));
    }
    if (auto done = check_kinds(*row, motion_kind, seen); !done) return done;
    if (is_skipped(row->kind)) {
      s.cl.summary.skip(code_of(word), line.number);
    }
    if (auto done = take_code(s, line, *row, shot); !done) return done;
  }
  const bool has_motion = seen[static_cast<std::size_t>(GKind::kMotion)];
  if (shot.kind != OneShot::Kind::kNothing || !has_motion) return {};
  return refuse("G5.1 beside G0 to G3", "write it in a block of its own", "G5.1");
}

bool moves(const Line& line) {
  return std::any_of(line.words.begin(), line.words.end(), [](const Word& word) {
    constexpr std::string_view kMoving = "XYZABCUVWIJKR";
    return word.address.size() > 1 || kMoving.find(word.address.front()) != std::string_view::npos;
  });
}

bool has_axis_word(const Line& line) {
  return std::any_of(line.words.begin(), line.words.end(), [](const Word& word) {
    constexpr std::string_view kAxes = "XYZUVW";
    return word.may_be_rotary() || kAxes.find(word.address.front()) != std::string_view::npos;
  });
}

cl::Outcome run_motion(State& s, const Line& line, OneShot shot) {
  if (shot.kind != OneShot::Kind::kPlaneTilt && moves(line)) {
    if (auto done = check_plane_is_whole(s); !done) return done;
  }
  switch (shot.kind) {
    case OneShot::Kind::kDwell:
      return dwell(s, line);
    case OneShot::Kind::kHome:
      return move_to_machine_position(s, line, MachinePosition::kHome);
    case OneShot::Kind::kReference:
      return move_to_machine_position(s, line, MachinePosition::kReference);
    case OneShot::Kind::kMachinePosition:
      return move_to_machine_position(s, line, MachinePosition::kAsWritten);
    case OneShot::Kind::kPlaneTilt:
      return define_plane(s, line);
    case OneShot::Kind::kPlaneFollow:
      if (moves(line)) {
        return refuse("G53.1 or G53.6 with words beside P", "write it in a block of its own");
      }
      return follow_plane(s, line);
    case OneShot::Kind::kLocalZero:
      return set_local_zero(s, line);
    case OneShot::Kind::kNothing:
      return {};
    case OneShot::Kind::kMove:
    case OneShot::Kind::kSetting:
      break;
  }
  if (!moves(line)) return {};
  if (shot.kind == OneShot::Kind::kSetting && !has_axis_word(line)) return {};
  if (s.modes.cycle.code != 0) return run_cycle(s, line);
  if (shot.kind == OneShot::Kind::kSetting) {
    s.cl.remarks.warn("setting", line.number, [] {
      return std::string("axis words beside a setting of the control are taken as motion");
    });
  }
  return move(s, line);
}

/// MCALL and what it calls: after a line that moves, or where the tool stands.
cl::Outcome run_holes(State& s, const Line& line, const NameOutcome& names, OneShot shot) {
  using Holes = NameOutcome::Holes;
  switch (names.holes) {
    case Holes::kNoMore:
      s.modes.at_every_point.reset();
      return {};
    case Holes::kAtEveryPoint:
      s.modes.at_every_point = names.drilling;
      return {};
    case Holes::kHere:
      return drill(s, line, names.drilling);
    case Holes::kAsBefore:
      break;
  }
  const bool is_motion = shot.kind == OneShot::Kind::kMove && moves(line);
  if (!s.modes.at_every_point || !is_motion) return {};
  return drill(s, line, *s.modes.at_every_point);
}

}  // namespace

cl::Outcome run_block(State& s, const Line& line) {
  if (auto done = check_addresses(line); !done) return done;
  if (s.modes.language == Language::kSiemens) {
    if (auto done = check_siemens_addresses(s, line); !done) return done;
  }
  OneShot shot;
  if (auto done = take_codes(s, line, shot); !done) return done;
  const auto names = take_names(s, line);
  if (!names) return tl::make_unexpected(names.error());
  if (names->has_frame) shot.kind = OneShot::Kind::kNothing;
  if (names->has_machine_position && moves(line)) shot.kind = OneShot::Kind::kMachinePosition;
  const bool is_dwell = shot.kind == OneShot::Kind::kDwell;
  if (is_dwell && s.modes.language == Language::kSiemens) return siemens_dwell(s, line);
  if (auto done = act_before(s, line); !done) return done;
  if (auto done = run_motion(s, line, shot); !done) return done;
  if (auto done = run_holes(s, line, *names, shot); !done) return done;
  return act_after(s, line);
}

}  // namespace meridian::nc
