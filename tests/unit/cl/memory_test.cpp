// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <istream>
#include <streambuf>

#include "service/programs/cl/cl_reader.hpp"
#include "support/heap_watch.hpp"

namespace meridian::cl {
namespace {

/// A program without end, made line by line.
class EndlessProgram : public std::streambuf {
 public:
  EndlessProgram() { load("UNITS/MM\nPARTNO ENDLESS\nSPINDL/1000,CLW\nFEDRAT/1000,MMPM\n"); }

 private:
  void load(const char* text) {
    size_ = std::snprintf(line_.data(), line_.size(), "%s", text);
    setg(line_.data(), line_.data(), line_.data() + size_);
  }
  int_type underflow() override {
    const double t = 0.01 * static_cast<double>(++count_);
    std::array<char, 300> text{};
    const double x = 10 * std::cos(t);
    const double y = 10 * std::sin(t);
    if (count_ % 3 == 0) {
      std::snprintf(
          text.data(), text.size(),
          "PAINT/COLOR,%d\r\n$$ note\nCIRCLE/0,0,0,0,0,-1,10\nGOTO/%.10f,%.10f,0,0.,.6,.8\n",
          count_, x, y);
    } else {
      std::snprintf(text.data(), text.size(), "FEDRAT/%d,MMPM\nGOTO/%.10f,%.10f,0,$\n0.,.6,.8\n",
                    1000 + count_ % 100, x, y);
    }
    load(text.data());
    return traits_type::to_int_type(*gptr());
  }

  std::array<char, 300> line_{};
  int size_ = 0;
  int count_ = 0;
};

TEST(Memory, OfTheReaderDoesNotGrowWithTheFile) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "the heap is not watched under sanitizers";
  EndlessProgram program;
  std::istream stream(&program);
  ClReader reader(stream, "endless");
  const auto read = [&reader](int blocks) {
    for (int i = 0; i < blocks; ++i) {
      const auto block = reader.next();
      ASSERT_TRUE(block && *block) << i;
    }
  };
  read(2000);
  const watch::HeapWatch heap;
  read(100000);
  EXPECT_EQ(heap.calls().allocations, 0U);
}

}  // namespace
}  // namespace meridian::cl
