// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/dialect.hpp"

#include <algorithm>
#include <array>

#include "service/programs/cl/text/letters.hpp"

namespace meridian::cl {
namespace {

using enum MissingAxis;
constexpr auto kNumbersAsk = CycleNumbers::kAsk;

constexpr std::array kDialects = std::to_array<DialectTraits>({
    {Dialect::kUnknown, "", "APT", kAsk, false, false, kNumbersAsk},
    {Dialect::kNx, "nx", "NX CLSF", kStays, false, true, kNumbersAsk},
    {Dialect::kCatia, "catia", "CATIA APT", kAsk, false, false, kNumbersAsk},
    {Dialect::kCreo, "creo", "Creo NCL", kPlusZ, true, false, kNumbersAsk},
    {Dialect::kSolidWorks, "solidworks", "SolidWorks CAM APT", kCsys, false, false, kNumbersAsk},
    {Dialect::kMastercam, "mastercam", "Mastercam APT", kAsk, false, false, kNumbersAsk},
    {Dialect::kHyperMill, "hypermill", "hyperMILL APT", kAsk, false, false, kNumbersAsk},
    {Dialect::kMakino, "makino", "Makino FF CLDATA", kAsk, false, false, kNumbersAsk},
    {Dialect::kHsm, "hsm", "HSM APT", kAsk, false, false, CycleNumbers::kDepthUnitFeed},
    {Dialect::kFusion, "fusion", "Autodesk ISO 4343 APT", kAsk, false, false,
     CycleNumbers::kFromBottom},
    {Dialect::kIso, "iso", "ISO 4343 APT", kAsk, false, false, kNumbersAsk},
    {Dialect::kFanuc, "fanuc", "NC program, Fanuc and ISO words", kStays, false, true, kNumbersAsk},
    {Dialect::kSiemens, "siemens", "NC program, Siemens words", kStays, false, true, kNumbersAsk},
    {Dialect::kHeidenhain, "heidenhain", "NC program, Klartext", kStays, false, true, kNumbersAsk},
});

struct Evidence {
  std::string_view text;  ///< in capitals
  Dialect dialect;
};

/// What systems write about themselves at the head of a file. A name that somebody could write
/// about a part ("modelled in Creo") is no evidence where the dialect changes what points mean.
constexpr std::array kEvidence = std::to_array<Evidence>({
    {"*CATIA0", Dialect::kCatia},
    {"CATIA APT VERSION", Dialect::kCatia},
    {"PRO/CLFILE", Dialect::kCreo},
    {"MASTERCAM", Dialect::kMastercam},
    {"HYPERMILL", Dialect::kHyperMill},
    {"APTCL-SPEC,MAKINO", Dialect::kMakino},
});

/// Whether `text` holds `what` as words of their own.
bool holds(std::string_view text, std::string_view what) {
  const auto same = [](char a, char b) { return capital(a) == b; };
  for (auto at = text.begin();; ++at) {
    at = std::search(at, text.end(), what.begin(), what.end(), same);
    if (at == text.end()) return false;
    const auto rest = at + static_cast<std::ptrdiff_t>(what.size());
    if ((at == text.begin() || !is_letter(at[-1])) && (rest == text.end() || !is_letter(*rest)))
      return true;
  }
}

}  // namespace

std::span<const DialectTraits> dialects() { return kDialects; }

const DialectTraits& traits_of(Dialect dialect) {
  return kDialects[static_cast<std::size_t>(dialect)];
}

std::optional<Dialect> find_dialect(std::string_view name) {
  const auto at = std::find_if(kDialects.begin() + 1, kDialects.end(),
                               [name](const DialectTraits& row) { return row.name == name; });
  if (at == kDialects.end()) return std::nullopt;
  return at->dialect;
}

Dialect shown_by_text(std::string_view text) {
  const auto at = std::find_if(kEvidence.begin(), kEvidence.end(),
                               [text](const Evidence& row) { return holds(text, row.text); });
  return at == kEvidence.end() ? Dialect::kUnknown : at->dialect;
}

DialectFinder::DialectFinder(std::optional<Dialect> given)
    : dialect_(given.value_or(Dialect::kUnknown)),
      traits_(&traits_of(dialect_)),
      source_(given ? Source::kCaller : Source::kNobody),
      reason_(given ? "--dialect" : "") {}

bool DialectFinder::see(Dialect dialect, std::uint32_t line, std::string_view what) {
  if (dialect == Dialect::kUnknown || dialect == dialect_ || is_reported()) return true;
  if (source_ != Source::kNobody) {
    source_ = Source::kContradicted;
    return false;
  }
  source_ = Source::kFile;
  dialect_ = dialect;
  traits_ = &traits_of(dialect);
  reason_ = std::string(what) + " in line " + std::to_string(line);
  return true;
}

}  // namespace meridian::cl
