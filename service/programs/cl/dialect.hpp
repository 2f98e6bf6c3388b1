// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace meridian::cl {

/// The CAM systems whose CL files differ in what they mean, and languages of NC programs.
enum class Dialect : std::uint8_t {
  kUnknown,
  kNx,
  kCatia,
  kCreo,
  kSolidWorks,
  kMastercam,
  kHyperMill,
  kMakino,
  kHsm,     ///< the post Generative Machining APT
  kFusion,  ///< Autodesk's post Common ISO 4343 APT
  kIso,
  kFanuc,      ///< no CL file: an NC program of ISO and Fanuc words
  kSiemens,    ///< no CL file: an NC program of Siemens words
  kHeidenhain  ///< no CL file: an NC program in Klartext
};

/// Whether it is the language of NC programs.
[[nodiscard]] constexpr bool is_nc(Dialect dialect) noexcept {
  return dialect == Dialect::kFanuc || dialect == Dialect::kSiemens ||
         dialect == Dialect::kHeidenhain;
}

/// What a point of three numbers means where the tool axis was tilted before it.
enum class MissingAxis : std::uint8_t {
  kStays,  ///< the axis of the point before
  kPlusZ,  ///< +z of the frame
  kCsys,   ///< z of the last CSYS
  kAsk     ///< not known for certain: refused unless `--dialect` says it
};

/// How the numbers of a canned cycle are meant where no keyword stands before them.
enum class CycleNumbers : std::uint8_t {
  kAsk,            ///< as the table of a post-processor says: refused
  kDepthUnitFeed,  ///< depth, unit, feed, clearance above the bottom; RAPTO: down from there
  kFromBottom      ///< the same of points that are bottoms, and the clearance is a Z
};

/// One row of the table of dialects.
struct DialectTraits {
  Dialect dialect;
  std::string_view name;   ///< of `--dialect`
  std::string_view title;  ///< of the summary
  MissingAxis missing_axis;
  bool has_point_lists;    ///< lines of bare numbers after a GOTO are more points
  bool depth_is_negative;  ///< FEDTO counts down from the point with its sign
  CycleNumbers cycle_numbers;
};

[[nodiscard]] std::span<const DialectTraits> dialects();
[[nodiscard]] const DialectTraits& traits_of(Dialect dialect);
[[nodiscard]] std::optional<Dialect> find_dialect(std::string_view name);

/// What a comment or a note shows of the system that wrote the file; kUnknown: nothing.
[[nodiscard]] Dialect shown_by_text(std::string_view text);

/// Decides once per file what wrote it: what the caller says wins, else what the file shows first.
/// Proof: tests/unit/cl/dialect_test.cpp.
class DialectFinder {
 public:
  explicit DialectFinder(std::optional<Dialect> given);

  /// The file shows `dialect` by `what`, in this line. False where it showed another one before.
  [[nodiscard]] bool see(Dialect dialect, std::uint32_t line, std::string_view what);

  [[nodiscard]] Dialect dialect() const noexcept { return dialect_; }
  [[nodiscard]] const DialectTraits& traits() const noexcept { return *traits_; }
  [[nodiscard]] bool is_reported() const noexcept { return source_ == Source::kCaller; }
  [[nodiscard]] bool is_known() const noexcept { return dialect_ != Dialect::kUnknown; }
  /// What a missing axis means. What the caller said is certain; what two systems claim is not.
  [[nodiscard]] MissingAxis missing_axis() const noexcept {
    if (source_ == Source::kContradicted) return MissingAxis::kAsk;
    const MissingAxis row = traits_->missing_axis;
    return is_reported() && row == MissingAxis::kAsk ? MissingAxis::kStays : row;
  }
  /// "TOOL PATH in line 1", "--dialect"; empty where nothing shows it.
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

 private:
  /// Who says what the dialect is.
  enum class Source : std::uint8_t {
    kNobody,
    kFile,          ///< its first word that shows one
    kContradicted,  ///< the same, and a later word shows another one
    kCaller         ///< whatever the file shows
  };

  Dialect dialect_ = Dialect::kUnknown;
  const DialectTraits* traits_;
  Source source_ = Source::kNobody;
  std::string reason_;
};

}  // namespace meridian::cl
