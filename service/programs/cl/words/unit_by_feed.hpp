// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "service/programs/cl/interpreter/modal.hpp"
#include "service/programs/cl/text/statement.hpp"

namespace meridian::cl {

/// Keeps the unit that a FEDRAT or CYCLE shows, until the first motion has settled what holds.
void see_unit_by_feed(Modal& m, const Statement& s);

/// What the first feed word in millimetre or inch behind the last line shows. Nothing where a unit
/// word or the end of the program comes before it, or where the text cannot be read twice. Proof:
/// tests/unit/cl/unit_by_feed_test.cpp.
[[nodiscard]] std::optional<ShownUnit> unit_by_feed_ahead(LineSource& lines);

}  // namespace meridian::cl
