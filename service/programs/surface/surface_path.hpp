// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "service/programs/surface/shape/contact.hpp"

namespace meridian::surface {

/// How a patch is covered with lines. Each of the two spacings is either a count or a bound.
/// Units: mm; parameters of the patch.
struct CoverOptions {
  bool is_zigzag = true;      ///< every second line runs backwards, joined on the surface
  std::size_t points = 0;     ///< of each line, even in the parameter; 0: `chord_error_mm` rules
  double chord_error_mm = 0;  ///< largest distance between path and surface, lines and crossings
  std::size_t lines = 0;      ///< even in the parameter; 0: `scallop_mm` rules
  double scallop_mm = 0;      ///< largest height of a cusp between lines
  std::array<double, 2> range_u{};  ///< what is covered
  std::array<double, 2> range_v{};
};

/// Contacts in the order in which they are cut: lines, each followed by the contacts inside the
/// crossing to the next one (none in a one-way path, and none where the counts are even).
struct SurfacePath {
  struct Line {
    double parameter = 0;  ///< the parameter that stays the same on it
    std::vector<Contact> contacts;
    std::vector<Contact> crossing;
  };
  std::vector<Line> lines;
  bool is_zigzag = true;
};

/// Every contact, in the order in which they are cut. The path must live as long.
[[nodiscard]] std::vector<const Contact*> in_order(const SurfacePath& path);

/// Why there is no path: what is wrong, what to do.
struct PathFault {
  std::string what;
  std::string remedy;
};

/// Covers the patch. Faults: a point without normal, a crease, a bound that this cutter cannot
/// keep, more than kMaxContacts. Source: docs/surface.md, chapter 3. Proof:
/// tests/unit/surface/surface_path_test.cpp.
[[nodiscard]] Expected<SurfacePath, PathFault> cover(const ContactRule& rule,
                                                     const CoverOptions& options);
inline constexpr std::size_t kMaxContacts = 1'000'000;

/// Largest cusp between the lines at parameters `a` and `b` (see scallop_between). None where the
/// surface has no normal on them. Units: mm.
[[nodiscard]] std::optional<double> scallop_of_lines(const ContactRule& rule,
                                                     const CoverOptions& options, double a,
                                                     double b);

}  // namespace meridian::surface
