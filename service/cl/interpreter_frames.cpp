// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "service/cl/interpreter.hpp"

namespace meridian::cl {

Interpreter::Result Interpreter::take_mode(const Statement& s) {
  if (s.has_word("INCR") || s.has_word("INCREM")) {
    return refuse(s.line, "incremental coordinates", "output absolute coordinates");
  }
  return {};
}

Interpreter::Result Interpreter::take_cycle(const Statement& s) {
  for (const std::string_view word : {"OFF", "INIT", "NOMORE"}) {
    if (s.argument_count > 0 && is_word(s.arguments[0].text, word)) return {};
  }
  return refuse(s.line,
                "CYCLE/" + std::string(s.rest.substr(0, 40)) +
                    " is a canned cycle: its motion is known to the control alone",
                "let the CAM system write cycles out as motion");
}

Interpreter::Result Interpreter::take_frame(const Statement& s, Word word) {
  const bool is_msys = word == Word::kMsys;
  std::optional<Frame> frame;
  const std::size_t wanted = is_msys ? 9 : 12;
  if (!s.all_numbers() || s.argument_count != wanted) {
    return refuse(s.line, std::string(is_msys ? "MSYS" : "CSYS") + " needs " +
                              std::to_string(wanted) + " numbers, here are " +
                              std::to_string(s.number_count));
  }
  std::array<double, 12> v{};
  for (std::size_t i = 0; i < wanted; ++i) v[i] = s.arguments[i].number;
  frame = is_msys ? frame_from_axes(std::span<const double, 9>(v.data(), 9)) : frame_from_rows(v);
  if (!frame) {
    return refuse(s.line, std::string(is_msys ? "MSYS" : "CSYS") +
                              " is no right-handed frame of unit vectors square to each other");
  }
  if (arc_.form != ArcForm::kNone) {
    return refuse(s.line, "the frame changes between CIRCLE and its GOTO");
  }
  written_frame_ = *frame;
  written_is_csys_ = !is_msys;
  frame_dirty_ = true;
  return {};
}

Interpreter::Result Interpreter::take_transform(const Statement& s) {
  if (s.argument_count == 1 && s.has_word("WORLD")) {
    csys_holds_ = false;
  } else if (s.argument_count == 1 && s.has_word("LOCAL")) {
    csys_holds_ = true;
  } else {
    return refuse(s.line, "TRNTYP/" + std::string(s.rest) + " is not understood",
                  "TRNTYP/WORLD or TRNTYP/LOCAL");
  }
  summary_.dialect = "SolidWorks CAM APT";
  frame_dirty_ = true;
  return {};
}

/// Poses are given in one frame W: the frame in force at the first motion. A later frame is put
/// through `reference⁻¹ · later`.
Interpreter::Result Interpreter::resolve_frame(std::uint32_t line) {
  frame_dirty_ = false;
  Frame now;
  if (written_frame_ && (csys_holds_ || !written_is_csys_)) {
    now = *written_frame_;
    now.origin *= to_mm_;
  }
  if (!reference_) {
    reference_ = now;
    return {};
  }
  Frame moved = relative(*reference_, now);
  if (is_identity(moved)) moved = Frame{};
  if (options_.frame) moved = compose(*options_.frame, moved);
  const Frame before = frame_;
  const Frame change = relative(before, moved);
  if (is_identity(change)) return {};
  frame_ = moved;
  frame_is_identity_ = is_identity(frame_);
  axis_ =
      frame_.direction(Vector3(axis_written_[0], axis_written_[1], axis_written_[2]).normalized());
  ++summary_.frame_changes;
  warn_once("frame", line, [&] {
    return std::string(
        "the file changes its frame after motion has begun: all poses are given in the first one");
  });
  return {};
}

Interpreter::Result Interpreter::take_tool_path(const Statement& s) {
  summary_.dialect = "NX CLSF";
  if (open_path_line_ != 0) {
    return refuse(s.line, "TOOL PATH inside the TOOL PATH of line " +
                              std::to_string(open_path_line_) + ": the file is cut and joined?");
  }
  open_path_line_ = s.line;
  if (summary_.program.empty()) {
    summary_.program = std::string(s.rest.substr(0, std::min<std::size_t>(s.rest.find(','), 80)));
  }
  return {};
}

/// PPRINT is free text; Makino writes its structure into it.
Interpreter::Result Interpreter::take_note(const Statement& s) {
  std::string_view text = s.rest;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (text.starts_with("APTCL-SPEC,MAKINO")) summary_.dialect = "Makino FF CLDATA";
  if (text.starts_with("BEGIN-SECTION")) ++open_sections_;
  if (text.starts_with("END-SECTION")) {
    --open_sections_;
    if (open_sections_ < 0) return refuse(s.line, "PPRINT/END-SECTION without BEGIN-SECTION");
    sections_closed_ = true;
  }
  return {};
}

}  // namespace meridian::cl
