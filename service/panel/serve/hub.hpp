// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace meridian::panel {

/// What every page is shown, between the thread that reads the topics and those that write to
/// pages. A page that reads slowly gets the newest of each kind and misses what came in between: it
/// holds up nobody, and nothing grows. Any thread. Proof: tests/panel/panel_unit_test.cpp.
class Hub {
 public:
  /// Pages get the first ones, kPageKinds of them.
  enum Kind : std::size_t {
    kMachine,
    kNews,
    kLatency,
    kProgram,
    kActions,
    kFrame,
    kPageKinds,
    kMetrics = kPageKinds,
    kKinds
  };
  using Text = std::shared_ptr<const std::string>;

  /// How far a reader has come; one each.
  struct Cursor {
    std::array<std::uint64_t, kPageKinds> seen{};
  };

  /// Puts the newest text of `kind` in place of the last.
  void publish(Kind kind, std::string text);

  /// Waits for texts that `cursor` has not seen, at most `patience`, and returns them, the machine
  /// first. Nothing where time was up or the hub is closed.
  [[nodiscard]] std::vector<Text> wait(Cursor& cursor, std::chrono::milliseconds patience);

  /// The newest text of `kind`; nullptr where there was none.
  [[nodiscard]] Text newest(Kind kind) const;

  /// Lets everybody who waits go.
  void close();
  [[nodiscard]] bool is_closed() const;

 private:
  [[nodiscard]] bool has_news(const Cursor& cursor) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Text, kKinds> texts_{};
  std::array<std::uint64_t, kPageKinds> numbers_{};  ///< how many texts of a kind there were
  bool is_closed_ = false;
};

}  // namespace meridian::panel
