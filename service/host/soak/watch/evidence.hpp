// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace meridian::soak {

/// What is put aside for whoever looks into a violation: copies in a folder, NAME1.ENDING,
/// NAME2.ENDING and so on. Proof: tests/unit/soak/evidence_test.cpp.
class Evidence {
 public:
  /// Removes what a soak before left of that name in `folder`. Of the first `max` finds something
  /// is kept; an empty folder: of none.
  Evidence(std::filesystem::path folder, std::string name, int max);

  struct Piece {
    std::filesystem::path file;
    std::string ending;
  };
  /// Copies what there is of `pieces`. Returns FOLDER/NAMEn, or "" where nothing was kept.
  std::string keep(std::initializer_list<Piece> pieces);

 private:
  std::filesystem::path folder_;
  std::string name_;
  int max_, count_ = 0;
};

}  // namespace meridian::soak
