// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "meridian/units.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"

namespace meridian::cl {
namespace {

constexpr const char* kNoFrame = " is no right-handed frame of unit vectors square to each other";

/// The numbers of a statement that must be just so many.
Expected<std::array<double, 12>, Refusal> numbers_of(const Statement& s, std::size_t wanted) {
  if (!s.all_numbers() || s.argument_count != wanted) {
    return refuse(std::string(s.major) + " needs " + std::to_string(wanted) +
                  " numbers, here are " + std::to_string(s.number_count));
  }
  std::array<double, 12> v{};
  for (std::size_t i = 0; i < wanted; ++i) v[i] = s.arguments[i].number;
  return v;
}

Outcome refuse_inside_curve(const Modal& m, const Statement& s) {
  if (m.curve.index() == 0) return {};
  return refuse(std::string(s.major) + ": the frame changes between CIRCLE and its GOTO",
                "change it before CIRCLE or after the GOTO");
}

/// Three rows of four.
Expected<Frame, Refusal> matrix_of(const Statement& s) {
  const auto v = numbers_of(s, 12);
  if (!v) return tl::make_unexpected(v.error());
  const auto frame = frame_from_rows(*v);
  if (!frame) return refuse(std::string(s.major.empty() ? "CSYS" : s.major) + kNoFrame);
  return *frame;
}

}  // namespace

Outcome read_msys(Modal& m, const Statement& s) {
  const auto v = numbers_of(s, 9);
  if (!v) return tl::make_unexpected(v.error());
  const auto frame = frame_from_axes(std::span<const double, 9>(v->data(), 9));
  if (!frame) return refuse(std::string("MSYS") + kNoFrame);
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  m.frames.set_frame(*frame, FrameChain::Kind::kMsys);
  return {};
}

/// MCS of CAMplete files: the axes x, y and z of the frame, and then its origin.
Outcome read_mcs(Modal& m, const Statement& s) {
  const auto v = numbers_of(s, 12);
  if (!v) return tl::make_unexpected(v.error());
  std::array<double, 12> rows{};
  for (std::size_t i = 0; i < 12; ++i) rows[4 * (i % 3) + i / 3] = (*v)[i];
  const auto frame = frame_from_rows(rows);
  if (!frame) return refuse(std::string("MCS") + kNoFrame);
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  m.frames.set_frame(*frame, FrameChain::Kind::kMsys);
  return {};
}

/// MCSYS/NUM,n,POINT,x,y,z,VECTOR,i,j,k,VECTOR,i,j,k of MfgSuite: a work offset, and the origin and
/// the axes x and y in it.
Outcome read_mcsys(Modal& m, const Statement& s) {
  constexpr std::array<std::pair<std::size_t, std::string_view>, 4> kWords = {
      {{0, "NUM"}, {2, "POINT"}, {6, "VECTOR"}, {10, "VECTOR"}}};
  const bool is_whole = s.argument_count == 14 && s.number_count == 10 &&
                        std::all_of(kWords.begin(), kWords.end(), [&s](const auto& word) {
                          return is_word(s.arguments[word.first].text, word.second);
                        });
  if (!is_whole) return refuse("MCSYS needs NUM, POINT and two times VECTOR with their numbers");
  const double offset = s.arguments[1].number;
  if (m.work_offset.value_or(offset) != offset) {
    return refuse("MCSYS/NUM," + short_number(offset) + " after NUM," +
                      short_number(*m.work_offset) +
                      ": how far the two work offsets are apart is known to the control alone",
                  "output all operations in one work offset");
  }
  std::array<double, 9> v{};
  for (std::size_t i = 0; i < 9; ++i) v[i] = s.arguments[3 + i + i / 3].number;
  const auto frame = frame_from_axes(v);
  if (!frame) return refuse(std::string("MCSYS") + kNoFrame);
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  m.work_offset = offset;
  m.frames.set_frame(*frame, FrameChain::Kind::kMsys);
  return {};
}

Outcome read_csys(Modal& m, const Statement& s) {
  const auto frame = matrix_of(s);
  if (!frame) return tl::make_unexpected(frame.error());
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  m.frames.set_frame(*frame, FrameChain::Kind::kCsys);
  return {};
}

/// TRNTYP/WORLD[,0,0,0] and TRNTYP/LOCAL.
Outcome read_trntyp(Modal& m, const Statement& s) {
  const bool is_world = s.has_word("WORLD"), is_local = s.has_word("LOCAL");
  const bool has_shift = std::any_of(
      s.arguments.begin(), s.arguments.begin() + static_cast<std::ptrdiff_t>(s.argument_count),
      [](const Argument& a) { return a.is_number && a.number != 0; });
  const bool is_whole = s.number_count + 1 == s.argument_count && !has_shift;
  if (is_world == is_local || !is_whole) {
    return refuse("TRNTYP/" + std::string(s.rest.substr(0, 40)) + " is not understood",
                  "TRNTYP/WORLD,0,0,0 or TRNTYP/LOCAL");
  }
  m.frames.set_world(is_world);
  return {};
}

/// A post-processor takes ORIGIN off every point.
Outcome read_origin(Modal& m, const Statement& s) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 2 && n != 3 && n != 9)) {
    return refuse("ORIGIN needs 2, 3 or 9 numbers");
  }
  std::array<double, 9> v{0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (std::size_t i = 0; i < n; ++i) v[i] = s.arguments[i].number;
  const bool is_turned = v[3] != 1 || v[4] != 0 || v[5] != 0 || v[6] != 0 || v[7] != 0 || v[8] != 1;
  const bool is_shifted = v[0] != 0 || v[1] != 0 || v[2] != 0;
  if (n == 9 && (is_turned || is_shifted)) {
    return refuse(
        "ORIGIN with axes sets a frame of its own, and does not say whether the points are in it",
        "output the points in the machining axis system, ORIGIN/0,0,0");
  }
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  if (is_shifted) {
    m.remarks.warn("ORIGIN", s.line, [&] {
      return "ORIGIN: (" + short_number(v[0]) + ", " + short_number(v[1]) + ", " +
             short_number(v[2]) + ") is taken off every point, as a post-processor does";
    });
  }
  m.frames.set_origin({v[0], v[1], v[2]});
  return {};
}

/// TRANS/x,y,z and TRANS/ three rows of four: until the next one.
Outcome read_trans(Modal& m, const Statement& s) {
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  if (s.argument_count == 12) {
    const auto frame = matrix_of(s);
    if (!frame) return tl::make_unexpected(frame.error());
    m.frames.set_shift(*frame);
    return {};
  }
  if (!s.all_numbers() || s.argument_count != 3) {
    return refuse("TRANS/" + std::string(s.rest.substr(0, 40)) + " is not understood",
                  "TRANS with three numbers, or the twelve of a rigid frame");
  }
  const Vector3 shift = to_vector(numbers_from(s, 0));
  if (shift.isZero(0)) {
    m.frames.set_shift(std::nullopt);
    return {};
  }
  m.remarks.warn("TRANS", s.line, [] { return "TRANS: the points after it are shifted by it"; });
  m.frames.set_shift(Frame{Eigen::Matrix3d::Identity(), shift});
  return {};
}

/// TRACUT/ three rows of four: points and axes behind it are put through it; NOMORE ends it.
Outcome read_tracut(Modal& m, const Statement& s) {
  if (auto done = refuse_inside_curve(m, s); !done) return done;
  if (s.argument_count == 1 && s.has_word("NOMORE")) {
    m.frames.set_transformation(std::nullopt);
    return {};
  }
  const auto frame = matrix_of(s);
  if (!frame) return tl::make_unexpected(frame.error());
  m.remarks.warn("TRACUT", s.line,
                 [] { return "TRACUT: the points after it are put through its matrix"; });
  m.frames.set_transformation(*frame);
  return {};
}

/// ROTABL, ROTATE, ROTHED, INDPOS: at zero they change nothing; elsewhere only points that carry
/// their tool axis say where they lie without the machine.
Outcome read_rotary(Modal& m, const Statement& s) {
  bool is_zero = s.number_count > 0;
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const Argument& a = s.arguments[i];
    if (a.is_number && std::remainder(a.number, 360.0) != 0) is_zero = false;
  }
  if (m.curve.index() != 0 || m.cycle) {
    return refuse(std::string(s.major) + " inside an arc, a spline or a cycle",
                  "write it before or after");
  }
  m.summary.skip(s.major, s.line);
  m.rotary.line = is_zero ? 0 : s.line;
  m.rotary.text = std::string(s.major) + "/" + std::string(s.rest.substr(0, 40));
  return {};
}

Outcome read_mode(Modal& m, const Statement& s) {
  if (s.has_word("INCR") || s.has_word("INCREM")) {
    return refuse("incremental coordinates", "output absolute coordinates");
  }
  if (s.major == "SET") return skip(m, s);
  for (const char* const word : {"TURN", "LATHE", "POLAR", "CYLNDR", "DIAMTR", "TOOL", "AXIS"}) {
    if (s.has_word(word)) {
      return refuse(
          std::string(s.major) + "/" + std::string(word) + " changes what the points after it mean",
          "output points of the tool tip in the part");
    }
  }
  if (!s.has_word("MILL") && !s.has_word("ABSOL")) {
    m.remarks.warn(s.major, s.line, [&s] {
      return std::string(s.major) + "/" + std::string(s.rest.substr(0, 24)) +
             " is skipped: what it asks of a post-processor is not done";
    });
  }
  return skip(m, s);
}

}  // namespace meridian::cl
