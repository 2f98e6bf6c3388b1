// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/surface_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "meridian/units.hpp"
#include "service/programs/surface/shape/stepping.hpp"

namespace meridian::surface {
namespace {

/// Between the samples of an error it may be a little larger than at them.
constexpr double kMargin = 0.98;
constexpr std::size_t kMaxLines = 100'000;
constexpr int kScallopSamples = 16;  // on each piece of a line

std::vector<double> even_parameters(const std::array<double, 2>& range, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    out.push_back(i + 1 == count ? range[1] : range[0] + share * (range[1] - range[0]));
  }
  return out;
}

std::string parameter(double u, double v) {
  char text[80];
  std::snprintf(text, sizeof text, "u = %.6g, v = %.6g", u, v);
  return text;
}

std::string crease_text(bool is_u, double knot, double turn_rad) {
  char text[120];
  std::snprintf(text, sizeof text, "the surface has a crease of %.4g deg at %c = %.6g",
                units::deg_from_rad(turn_rad), is_u ? 'u' : 'v', knot);
  return text;
}

/// Finds contacts and lays lines; the first fault is kept.
class Cover {
 public:
  Cover(const ContactRule& rule, const CoverOptions& options) : rule_(rule), options_(options) {
    const bool along_u = rule.runs_along_u;
    along_ = along_u ? options.range_u : options.range_v;
    across_ = along_u ? options.range_v : options.range_u;
    along_breaks_ = along_u ? rule.surface->breaks_u(along_) : rule.surface->breaks_v(along_);
    across_breaks_ = along_u ? rule.surface->breaks_v(across_) : rule.surface->breaks_u(across_);
  }

  Expected<SurfacePath, PathFault> run() {
    find_crease(along_breaks_, true);
    find_crease(across_breaks_, false);
    if (fault_) return tl::make_unexpected(std::move(*fault_));
    SurfacePath path;
    path.is_zigzag = options_.is_zigzag;
    const std::vector<double> rows = line_parameters();
    if (rows.size() * options_.points > kMaxContacts) refuse_count();
    std::size_t count = 0;
    for (std::size_t i = 0; i < rows.size() && !fault_; ++i) {
      SurfacePath::Line line;
      const bool is_back = options_.is_zigzag && i % 2 == 1;
      line.parameter = rows[i];
      line.contacts = contacts_of(rows[i], is_back);
      if (options_.is_zigzag && i + 1 < rows.size()) {
        line.crossing = crossing(is_back ? along_[0] : along_[1], rows[i], rows[i + 1]);
      }
      count += line.contacts.size() + line.crossing.size();
      if (count > kMaxContacts) refuse_count();
      path.lines.push_back(std::move(line));
    }
    if (fault_) return tl::make_unexpected(std::move(*fault_));
    return path;
  }

 private:
  std::optional<Contact> contact(double along, double across) {
    const double u = rule_.runs_along_u ? along : across;
    const double v = rule_.runs_along_u ? across : along;
    auto found = find_contact(rule_, u, v);
    if (!found && !fault_) {
      fault_ = PathFault{"the surface has no normal at " + parameter(u, v) +
                             ": an edge or a corner has shrunk to a point there",
                         "keep clear of it: path.range_u or path.range_v"};
    }
    return found;
  }

  /// Faults a knot at which the normals of both sides differ: a cutter cannot follow them there.
  void find_crease(const std::vector<double>& breaks, bool is_along) {
    constexpr double kBeside = 1e-7, kCrease_rad = 1e-4;
    constexpr std::size_t kSamples = 33;
    const double beside = kBeside * (breaks.back() - breaks.front());
    for (std::size_t i = 1; i + 1 < breaks.size() && !fault_; ++i) {
      for (const double other : even_parameters(is_along ? across_ : along_, kSamples)) {
        const auto shape = [&](double at) {
          const bool is_u = is_along == rule_.runs_along_u;
          return shape_at(*rule_.surface, is_u ? at : other, is_u ? other : at, rule_.is_flipped);
        };
        const auto before = shape(breaks[i] - beside), after = shape(breaks[i] + beside);
        if (!before || !after) continue;
        const double turn = std::atan2(before->normal.cross(after->normal).norm(),
                                       before->normal.dot(after->normal));
        if (turn < kCrease_rad || fault_) continue;
        fault_ = PathFault{crease_text(is_along == rule_.runs_along_u, breaks[i], turn),
                           "write a patch for each side, or cover one side: path.range_u or "
                           "path.range_v"};
      }
    }
  }

  void refuse_count() {
    if (fault_) return;
    fault_ = PathFault{"the path has more than " + std::to_string(kMaxContacts) + " contacts",
                       "allow more chord error or scallop, or cover less of the patch"};
  }

  /// Chord error of the step between two points of a way; `is_along`: the way is a line.
  std::optional<double> step_error(double fixed, double from, double to, bool is_along) {
    const auto a = is_along ? contact(from, fixed) : contact(fixed, from);
    const auto b = is_along ? contact(to, fixed) : contact(fixed, to);
    if (!a || !b) return std::nullopt;
    auto error = chord_error(rule_, *a, *b);
    if (!error && !fault_) {
      fault_ = PathFault{"the surface has no normal between " + parameter(a->u, a->v) + " and " +
                             parameter(b->u, b->v),
                         "keep clear of it: path.range_u or path.range_v"};
    }
    return error;
  }

  /// Places of a way whose blocks keep the chord error; it rests on every knot that it meets.
  std::vector<double> bounded_parameters(double fixed, const std::vector<double>& breaks,
                                         bool is_along) {
    std::vector<double> out{breaks.front()};
    for (std::size_t i = 1; i < breaks.size() && !fault_; ++i) {
      const bool is_kept = append_steps(
          out, breaks[i], kMargin * options_.chord_error_mm, kMaxContacts,
          [&](double from, double to) { return step_error(fixed, from, to, is_along); });
      if (!is_kept) refuse_count();
    }
    return out;
  }

  std::vector<Contact> contacts_of(double row, bool is_back) {
    const std::vector<double> parameters = options_.points > 0
                                               ? even_parameters(along_, options_.points)
                                               : bounded_parameters(row, along_breaks_, true);
    std::vector<Contact> out;
    for (const double along : parameters) {
      if (auto found = contact(along, row)) out.push_back(*found);
    }
    if (is_back) std::reverse(out.begin(), out.end());
    return out;
  }

  /// Contacts between two lines, their ends left out.
  std::vector<Contact> crossing(double along, double from, double to) {
    std::vector<Contact> out;
    if (options_.points > 0) return out;
    std::vector<double> breaks{from};
    for (const double b : across_breaks_) {
      if (b > from && b < to) breaks.push_back(b);
    }
    breaks.push_back(to);
    const std::vector<double> parameters = bounded_parameters(along, breaks, false);
    for (std::size_t i = 1; i + 1 < parameters.size(); ++i) {
      if (auto found = contact(along, parameters[i])) out.push_back(*found);
    }
    return out;
  }

  /// Faults a line on which the surface has no normal.
  void check_line(double row) {
    for (const double along : even_parameters(along_, 257)) (void)contact(along, row);
  }

  std::vector<double> line_parameters() {
    if (options_.lines > 0) return even_parameters(across_, options_.lines);
    std::vector<double> out{across_[0]};
    const bool is_kept = append_steps(
        out, across_[1], kMargin * options_.scallop_mm, kMaxLines,
        [&](double from, double to) { return scallop_of_lines(rule_, options_, from, to); });
    if (!is_kept && !fault_) check_line(out.back());
    if (!is_kept && !fault_) {
      fault_ =
          PathFault{"no line beside " + std::string(rule_.runs_along_u ? "v" : "u") + " = " +
                        std::to_string(out.back()) + " keeps the scallop with this cutter",
                    "allow a higher scallop, take another cutter, or lean a sharp corner along "
                    "the feed alone (tilt_deg = 0)"};
    }
    return out;
  }

  const ContactRule& rule_;
  const CoverOptions& options_;
  std::array<double, 2> along_{}, across_{};
  std::vector<double> along_breaks_, across_breaks_;
  std::optional<PathFault> fault_;
};

}  // namespace

std::optional<double> scallop_of_lines(const ContactRule& rule, const CoverOptions& options,
                                       double a, double b) {
  const bool along_u = rule.runs_along_u;
  const std::vector<double> breaks =
      along_u ? rule.surface->breaks_u(options.range_u) : rule.surface->breaks_v(options.range_v);
  double worst = 0;
  for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
    for (int i = 0; i <= kScallopSamples; ++i) {
      const double at = breaks[piece] + (breaks[piece + 1] - breaks[piece]) * i / kScallopSamples;
      const auto one = along_u ? find_contact(rule, at, a) : find_contact(rule, a, at);
      const auto other = along_u ? find_contact(rule, at, b) : find_contact(rule, b, at);
      if (!one || !other) return std::nullopt;
      worst = std::max(worst, scallop_between(rule, *one, *other));
    }
  }
  return worst;
}

Expected<SurfacePath, PathFault> cover(const ContactRule& rule, const CoverOptions& options) {
  return Cover(rule, options).run();
}

std::vector<const Contact*> in_order(const SurfacePath& path) {
  std::vector<const Contact*> out;
  for (const SurfacePath::Line& line : path.lines) {
    for (const Contact& c : line.contacts) out.push_back(&c);
    for (const Contact& c : line.crossing) out.push_back(&c);
  }
  return out;
}

}  // namespace meridian::surface
